// Tone maps, as in src/photo/tone.rs, which names the sources of every number here; and the encoding of sRGB.

float sound(float c) {
    return isnan(c) ? 0.0 : clamp(c, -1e9, 1e9);
}

vec3 reinhard(vec3 light) {
    light = max(light, 0.0);
    return light / (1.0 + light);
}

vec3 aces(vec3 light) {
    const mat3 into = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 back = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = max(into * light, 0.0);
    vec3 above = v * (v + 0.0245786) - 0.000090537;
    vec3 below = v * (0.983729 * v + 0.432951) + 0.238081;
    return back * (above / below);
}

vec3 agx(vec3 light) {
    const mat3 inset = mat3(
        0.84247906, 0.04232824, 0.042375654, 0.0784336, 0.87846864, 0.0784336, 0.079223745, 0.07916613, 0.879143);
    const mat3 outset = mat3(
        1.196879, -0.05289685, -0.052971635, -0.09802088, 1.1519031, -0.09804345, -0.09902974, -0.09896118, 1.1510737);
    const float darkest = -12.47393;
    const float lightest = 4.026069;
    vec3 stops = log2(max(inset * light, 1e-10));
    vec3 x = clamp((stops - darkest) / (lightest - darkest), 0.0, 1.0);
    vec3 curve = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
    return pow(clamp(outset * curve, 0.0, 1.0), vec3(2.2));
}

// Linear Rec.709 light, any value, to linear light in 0..1; NaN and -inf become 0.
vec3 tone_mapped(vec3 light) {
    bvec3 none = equal(light, vec3(uintBitsToFloat(0xff800000u)));
    light = mix(vec3(sound(light.r), sound(light.g), sound(light.b)), vec3(0.0), none);
#if TONE_MAP == TONE_MAP_REINHARD
    light = reinhard(light);
#elif TONE_MAP == TONE_MAP_ACES
    light = aces(light);
#elif TONE_MAP == TONE_MAP_AGX
    light = agx(light);
#endif
    return clamp(light, 0.0, 1.0);
}

// Light in 0..1 as sRGB encodes it.
vec3 srgb_encoded(vec3 light) {
    return mix(1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, light * 12.92, lessThanEqual(light, vec3(0.0031308)));
}

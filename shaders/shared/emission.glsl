const float LARGEST = uintBitsToFloat(0x7f7fffffu);
const float SMALLEST = uintBitsToFloat(0x00800000u); // of those that no device takes for nothing

// Brightness of what a pixel gives, as scene::Emission has it: linear luminance, or under BRIGHTEST the brightest channel of what
// has any. Not finite is none, a negative channel counts as 0 and so does a negative sum, and of straight colours alpha's share is given.
float emitted(vec4 pixel, vec3 weights) {
    if (any(isnan(pixel.rgb)) || any(isinf(pixel.rgb))) return 0.0;
    vec3 colour = max(pixel.rgb, 0.0);
    precise float sum = weights.r * colour.r + weights.g * colour.g + weights.b * colour.b;
#ifdef BRIGHTEST
    sum = sum >= SMALLEST ? max(max(colour.r, colour.g), colour.b) : 0.0;
#else
    sum = sum > 0.0 ? min(sum, LARGEST) : 0.0;
#endif
#ifdef STRAIGHT
    sum *= isnan(pixel.a) || isinf(pixel.a) ? 0.0 : clamp(pixel.a, 0.0, 1.0);
#endif
    return sum >= SMALLEST ? sum : 0.0;
}

// Whether a pixel that gives a brightness is light, as scene::is_light has it.
bool is_light(float brightness, float threshold) {
    return brightness >= threshold && brightness > 0.0;
}

// The share of a pixel's light that shines, as scene::Knee has it; of straight colours the threshold sees alpha's share.
float shining(vec4 pixel, vec2 knee) {
    float brightest = 0.0;
    for (int k = 0; k < 3; ++k) {
        if (!isnan(pixel[k]) && !isinf(pixel[k])) brightest = max(brightest, pixel[k]);
    }
#ifdef STRAIGHT
    brightest *= isnan(pixel.a) || isinf(pixel.a) ? 0.0 : clamp(pixel.a, 0.0, 1.0);
#endif
    if (!(brightest > 0.0)) return 0.0;
    float above = brightest - knee.x;
    float begun = clamp(above + knee.y, 0.0, 2.0 * knee.y);
    float soft = knee.y > 0.0 ? begun * (begun / (4.0 * knee.y)) : 0.0;
    return clamp(max(above, soft) / brightest, 0.0, 1.0);
}

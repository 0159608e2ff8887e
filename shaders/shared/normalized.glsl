// How a value of the field becomes glare: as it is, clamped to 0..1, or stretched to 0..1 by the range.
layout(binding = UNIT_RANGE) uniform sampler2D range;

// A range no wider than `flat_span` is rounding.
vec3 normalized(vec3 value, float flat_span) {
#if NORMALIZE == NORMALIZE_CLAMP
    return clamp(value, 0.0, 1.0);
#elif NORMALIZE == NORMALIZE_MINMAX
    vec2 ends = texelFetch(range, ivec2(0), 0).xy * vec2(1.0, -1.0); // (min, max)
    float span = ends.y - ends.x;
    return span > flat_span ? (value - ends.x) / span : vec3(0.0); // a flat field has no contrast to stretch
#else
    return value;
#endif
}

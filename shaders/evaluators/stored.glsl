// The field as a pass before this one stored it.
layout(binding = UNIT_FIELD) uniform sampler2D field;

vec3 glare(ivec2 pixel) {
    return texelFetch(field, pixel, 0).rgb;
}

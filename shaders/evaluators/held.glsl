// The field as it was drawn before, in units of its scale.
layout(binding = UNIT_FIELD) uniform sampler2D field;

vec3 glare(ivec2 pixel) {
    return texelFetch(field, pixel, 0).rgb;
}

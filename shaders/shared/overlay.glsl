// What is laid over a photo: a weighted sum of layers of the photo's size, or of means of them.
#ifdef OVERLAY_LAYERS
layout(binding = UNIT_OVERLAY) uniform sampler2D overlay[OVERLAY_LAYERS];

vec3 overlaid(ivec2 texel, mat4x3 weights) {
    vec3 sum = vec3(0.0);
    for (int layer = 0; layer < OVERLAY_LAYERS; layer++) {
        sum += weights[layer] * texelFetch(overlay[layer], texel, 0).rgb;
    }
    return sum;
}
#endif

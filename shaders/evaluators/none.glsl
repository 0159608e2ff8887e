// No light at all, where a layer is missing.
vec3 glare(ivec2 pixel) {
    return vec3(0.0);
}

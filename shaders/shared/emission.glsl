// Linear luminance of what a pixel gives, as scene::Emission has it: not finite is none, a negative channel counts as 0
// and so does a negative sum, and of straight colours alpha's share is given.
float emitted(vec4 pixel, vec3 weights) {
    if (any(isnan(pixel.rgb)) || any(isinf(pixel.rgb))) return 0.0;
    vec3 colour = max(pixel.rgb, 0.0);
    float sum = weights.r * colour.r + weights.g * colour.g + weights.b * colour.b;
#ifdef STRAIGHT
    sum *= isnan(pixel.a) || isinf(pixel.a) ? 0.0 : clamp(pixel.a, 0.0, 1.0);
#endif
    return sum > 0.0 ? sum : 0.0;
}

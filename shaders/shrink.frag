// The mean of a picture's light along one axis, x or y, for a view that makes it smaller.
layout(binding = UNIT_PICTURE) uniform sampler2D picture;
layout(std140, binding = BINDING_PASS) uniform Pass {
    float origin; // of the target's first texel along the axis, in the picture's texels
    float pitch;  // the picture's texels from one of the target to the next; above 1
    float end;    // of the picture along the axis
    int taps;     // texels that a mean looks at
    int stride;   // from one of them to the next
    int aside;    // the picture's texel across the axis that becomes the target's first
    int last;     // the picture's last texel along the axis
    int pad;
};
layout(location = 0) out vec4 mean;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef ALONG_Y
    float center = origin + pitch * (float(texel.y) + 0.5);
#else
    float center = origin + pitch * (float(texel.x) + 0.5);
#endif
    float low = max(center - 0.5 * pitch, 0.0);
    float high = min(center + 0.5 * pitch, end);
    int first = int(low);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
#ifdef TAPS
    for (int tap = 0; tap < TAPS; tap++) {
#else
    for (int tap = 0; tap < taps; tap++) {
#endif
        int at = first + stride * tap;
        float weight = min(float(at) + 1.0, high) - max(float(at), low);
        at = clamp(at, 0, last);
#ifdef ALONG_Y
        vec3 light = texelFetch(picture, ivec2(texel.x + aside, at), 0).rgb;
#else
        vec3 light = texelFetch(picture, ivec2(at, texel.y + aside), 0).rgb;
#endif
        // What is not finite must not be weighted by 0.
        sum += weight > 0.0 ? weight * light : vec3(0.0);
        weights += max(weight, 0.0);
    }
    mean = vec4(sum / weights, 1.0);
}

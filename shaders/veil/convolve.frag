// Taps along one axis, x or y: half of a separable kernel, or of the step up to the next lattice. There is nothing beyond the source.
layout(binding = UNIT_PHOTO) uniform sampler2D source;
#ifdef ADDED
layout(binding = UNIT_PICTURE) uniform sampler2D before; // what the sum is added to
#endif
layout(std140, binding = BINDING_PASS) uniform Pass {
    int first;  // texel of the source that the target's first texel meets with its first tap; negative before the source's first
    int stride; // the source's texels along the axis, from one of the target to the next
    int count;  // taps
    int end;    // texels of the source along the axis
    int aside;  // the source's texel across the axis that is beside the target's first
};
layout(std140, binding = BINDING_TAPS) uniform Taps {
    vec4 taps[VEIL_TAPS]; // one each, and three numbers that mean nothing
};
layout(location = 0) out vec4 sum;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef ALONG_Y
    int start = first + stride * texel.y;
    ivec2 at = ivec2(texel.x + aside, start);
    ivec2 next = ivec2(0, 1);
#else
    int start = first + stride * texel.x;
    ivec2 at = ivec2(start, texel.y + aside);
    ivec2 next = ivec2(1, 0);
#endif
    vec3 total = vec3(0.0);
    for (int tap = max(-start, 0), last = min(count, end - start); tap < last; ++tap) {
        total += taps[tap].x * texelFetch(source, at + tap * next, 0).rgb;
    }
#ifdef ADDED
    // By itself, so that what was there is rounded once.
    total += texelFetch(before, texel, 0).rgb;
#endif
    sum = vec4(total, 0.0);
}

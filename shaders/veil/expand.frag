// From a lattice to the next finer one along one axis, x or y: the transpose of the step up.
layout(binding = UNIT_PHOTO) uniform sampler2D source;
layout(std140, binding = BINDING_PASS) uniform Pass {
    int first; // point of the finer lattice that is the target's first
    int even;  // taps of a point with an even number
    int odd;   // of one with an odd number, which follow
    int end;   // texels of the source along the axis
};
layout(std140, binding = BINDING_TAPS) uniform Taps {
    vec4 taps[VEIL_TAPS];
};
layout(location = 0) out vec4 sum;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef ALONG_Y
    int point = first + texel.y;
    int start = point >> 1;
    ivec2 at = ivec2(texel.x, start);
    ivec2 next = ivec2(0, 1);
#else
    int point = first + texel.x;
    int start = point >> 1;
    ivec2 at = ivec2(start, texel.y);
    ivec2 next = ivec2(1, 0);
#endif
    bool is_odd = (point & 1) == 1;
    int begin = is_odd ? even : 0;
    vec3 total = vec3(0.0);
    for (int tap = 0, last = min(is_odd ? odd : even, end - start); tap < last; ++tap) {
        total += taps[begin + tap].x * texelFetch(source, at + tap * next, 0).rgb;
    }
    sum = vec4(total, 0.0);
}

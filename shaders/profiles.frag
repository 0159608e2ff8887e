// The series summed over m for each row of positions: what is left is a series in x alone.
//
//     P_n(y) = sum over m of  A c_m + B s_m        Q_n(y) = sum over m of  C c_m + D s_m
//
// Texel (2n, j) is P_n, texel (2n + 1, j) is Q_n at row j.
#include "shared/spectrum.glsl"

// The same terms in halves, (A, B) and (C, D): a texel needs one of the two, and what it does not load costs nothing.
layout(std430, binding = BINDING_SPECTRUM) readonly buffer Halves {
    vec2 halves[];
};
layout(binding = UNIT_HARMONICS_Y) uniform sampler2D harmonics_y;
layout(location = 0) out vec4 profile;

void main() {
    uvec2 texel = uvec2(gl_FragCoord.xy);
    uint n = texel.x / 2u;
    uint half_term = texel.x & 1u; // 0 for P, 1 for Q
    uint begin = offsets[n];
    uint count = offsets[n + 1u] - begin;
    vec3 sum = vec3(0.0);
    for (uint m = 0u; m < count; ++m) {
        vec2 y = texelFetch(harmonics_y, ivec2(texel.y, m), 0).xy;
        uint red = 6u * (begin + m) + half_term;
        sum += vec3(dot(halves[red], y), dot(halves[red + 2u], y), dot(halves[red + 4u], y));
    }
    profile = vec4(sum, 0.0);
}

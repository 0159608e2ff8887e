// The series summed over m for each row of positions: what is left is a series in x alone.
//
//     P_n(y) = sum over m of  A c_m + B s_m        Q_n(y) = sum over m of  C c_m + D s_m
//
// Texel (2n, j) is P_n, texel (2n + 1, j) is Q_n at row j.
#include "shared/spectrum.glsl"

layout(binding = UNIT_HARMONICS_Y) uniform sampler2D harmonics_y;
layout(location = 0) out vec4 profile;

void main() {
    uvec2 texel = uvec2(gl_FragCoord.xy);
    uint n = texel.x / 2u;
    bool sine = (texel.x & 1u) == 1u;
    uint begin = offsets[n];
    uint count = offsets[n + 1u] - begin;
    vec3 sum = vec3(0.0);
    for (uint m = 0u; m < count; ++m) {
        vec2 y = texelFetch(harmonics_y, ivec2(texel.y, m), 0).xy;
        uint term = 3u * (begin + m);
        vec4 red = terms[term], green = terms[term + 1u], blue = terms[term + 2u];
        sum += sine ? vec3(dot(red.zw, y), dot(green.zw, y), dot(blue.zw, y))
                    : vec3(dot(red.xy, y), dot(green.xy, y), dot(blue.xy, y));
    }
    profile = vec4(sum, 0.0);
}

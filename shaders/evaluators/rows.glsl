// `rows`: the profiles of the pixel's row, summed over n.
//
//     G(x, y) = sum over n of  P_n(y) c_n(x) + Q_n(y) s_n(x)
#include "shared/spectrum.glsl"

layout(binding = UNIT_HARMONICS_X) uniform sampler2D harmonics_x;
layout(binding = UNIT_PROFILES) uniform sampler2D profiles;

vec3 glare(ivec2 pixel) {
    vec3 sum = vec3(0.0);
    // Not textureSize: on Mesa's software renderer that made this loop sixty times slower.
    int rows = int(row_count);
    for (int n = 0; n < rows; ++n) {
        vec2 x = texelFetch(harmonics_x, ivec2(pixel.x, n), 0).xy;
        vec3 p = texelFetch(profiles, ivec2(2 * n, pixel.y), 0).rgb;
        vec3 q = texelFetch(profiles, ivec2(2 * n + 1, pixel.y), 0).rgb;
        sum += x.x * p + x.y * q;
    }
    return sum;
}

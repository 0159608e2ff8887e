// `series`: every kept mode at every pixel (rex's parametric case).
#include "shared/spectrum.glsl"

layout(binding = UNIT_HARMONICS_X) uniform sampler2D harmonics_x;
layout(binding = UNIT_HARMONICS_Y) uniform sampler2D harmonics_y;

vec3 glare(ivec2 pixel) {
    vec3 sum = vec3(0.0);
    // Not textureSize: on Mesa's software renderer that made this loop sixty times slower.
    int rows = int(row_count);
    for (int n = 0; n < rows; ++n) {
        vec2 x = texelFetch(harmonics_x, ivec2(pixel.x, n), 0).xy;
        uint begin = offsets[n];
        uint count = offsets[n + 1] - begin;
        vec3 row = vec3(0.0);
        for (uint m = 0u; m < count; ++m) {
            vec2 y = texelFetch(harmonics_y, ivec2(pixel.y, m), 0).xy;
            vec4 products = vec4(x.x * y, x.y * y);
            uint term = 3u * (begin + m);
            row += vec3(dot(terms[term], products), dot(terms[term + 1u], products), dot(terms[term + 2u], products));
        }
        sum += row;
    }
    return sum;
}

// `grid`: the cubic of the pixel's cell, which the strips hold for every row of the tile.
#include "shared/knots.glsl"

layout(binding = UNIT_STRIPS) uniform sampler2D strips;

float cubic(ivec2 texel, float t) {
    vec4 polynomial = texelFetch(strips, texel, 0);
    return polynomial.x + t * (polynomial.y + t * (polynomial.z + t * polynomial.w));
}

vec3 glare(ivec2 pixel) {
    Knot place = knot(knots_x, pixel.x);
    ivec2 texel = ivec2(3 * place.first, pixel.y);
    return vec3(cubic(texel, place.fraction), cubic(texel + ivec2(1, 0), place.fraction),
                cubic(texel + ivec2(2, 0), place.fraction));
}

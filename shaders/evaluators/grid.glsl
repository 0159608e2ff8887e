// `grid`: the cubic of the pixel's cell, which the strips hold for every row of the tile.
#include "shared/bspline.glsl"

layout(binding = UNIT_STRIPS) uniform sampler2D strips;
layout(std430, binding = BINDING_KNOTS_X) readonly buffer KnotsX {
    Knot knots_x[];
};

float cubic(ivec2 texel, float t) {
    vec4 polynomial = texelFetch(strips, texel, 0);
    return polynomial.x + t * (polynomial.y + t * (polynomial.z + t * polynomial.w));
}

vec3 glare(ivec2 pixel) {
    Knot knot = knots_x[pixel.x];
    ivec2 texel = ivec2(3u * knot.first, pixel.y);
    return vec3(cubic(texel, knot.fraction), cubic(texel + ivec2(1, 0), knot.fraction),
                cubic(texel + ivec2(2, 0), knot.fraction));
}

// `grid`: the strips, interpolated along x. They hold the lattice's columns at every row of the tile.
#include "shared/bspline.glsl"

layout(binding = UNIT_STRIPS) uniform sampler2D strips;
layout(std430, binding = BINDING_KNOTS_X) readonly buffer KnotsX {
    Knot knots_x[];
};

vec3 glare(ivec2 pixel) {
    Knot knot = knots_x[pixel.x];
    vec4 weights = cubic_weights(knot.fraction);
    ivec2 node = ivec2(knot.first, pixel.y);
    return weights.x * texelFetch(strips, node, 0).rgb + weights.y * texelFetch(strips, node + ivec2(1, 0), 0).rgb
         + weights.z * texelFetch(strips, node + ivec2(2, 0), 0).rgb + weights.w * texelFetch(strips, node + ivec2(3, 0), 0).rgb;
}

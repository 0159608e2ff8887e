// The lattice's cells along x: between each node and the next, the spline as a polynomial.
//
// Texel (3 c + colour, j) holds that of cell c at lattice row j, coefficients of 1, t, t^2, t^3: a pixel then needs one
// texel a colour instead of four, and no weights.
#include "shared/bspline.glsl"

layout(binding = UNIT_LATTICE) uniform sampler2D lattice;
layout(location = 0) out vec4 polynomial;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int cell = texel.x / 3;
    int colour = texel.x - 3 * cell;
    vec4 node;
    for (int k = 0; k < 4; ++k) {
        node[k] = texelFetch(lattice, ivec2(cell + k, texel.y), 0)[colour];
    }
    polynomial = cubic_polynomial(node);
}

// The lattice interpolated along y, at every row of the tile, in 64-bit floats.
#include "shared/bspline_double.glsl"
#include "shared/knots_double.glsl"

layout(local_size_x = DOUBLE_GROUP) in;
layout(std430, binding = BINDING_NODES) readonly buffer Nodes {
    double nodes[]; // red, green, blue: node by node, row by row
};
layout(std430, binding = BINDING_SUMS) writeonly buffer Strips {
    double strips[]; // the same, for rows of the tile
};

void main() {
    int column = int(gl_GlobalInvocationID.x), row = int(gl_GlobalInvocationID.y), stride = 3 * int(knots_x.z);
    if (column >= stride) {
        return;
    }
    Knot place = knot(knots_y, row);
    double weights[SPLINE_ORDER];
    spline_weights(exact_fraction(place), weights);
    double sum = 0.0lf;
    for (int k = 0; k < SPLINE_ORDER; ++k) {
        sum += weights[k] * nodes[(place.first + k) * stride + column];
    }
    strips[row * stride + column] = sum;
}

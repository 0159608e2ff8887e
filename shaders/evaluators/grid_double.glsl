// `grid` in 64-bit floats: the B-spline between the nodes that the strips hold for every row of the tile.
#include "shared/bspline_double.glsl"
#include "shared/knots_double.glsl"

layout(std430, binding = BINDING_SUMS) readonly buffer Strips {
    double strips[]; // red, green, blue: node by node, row by row
};

dvec3 glare(ivec2 pixel) {
    Knot place = knot(knots_x, pixel.x);
    double weights[SPLINE_ORDER];
    spline_weights(exact_fraction(place), weights);
    int node = 3 * (pixel.y * int(knots_x.z) + place.first);
    double red = 0.0lf, green = 0.0lf, blue = 0.0lf;
    for (int k = 0; k < SPLINE_ORDER; ++k) {
        red += weights[k] * strips[node + 3 * k];
        green += weights[k] * strips[node + 3 * k + 1];
        blue += weights[k] * strips[node + 3 * k + 2];
    }
    return dvec3(red, green, blue);
}

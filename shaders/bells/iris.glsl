// The opening of a lens with a smooth edge: a product of logistic steps, one for each side, or one step of the radius squared where it
// is round (src/series/iris.rs). The first row of its table has one over the edge, the distance of the sides, what is multiplied, and
// how many sides there are; the others have two sides each.
#include "shared/shapes.glsl"

#ifdef DOUBLE
#include "shared/double.glsl"

// 1/(1 + e^t)
double bell_step(double t) {
    precise double small = exponential(-abs(t));
    return (t > 0.0lf ? small : 1.0lf) / (1.0lf + small);
}

double bell_value(dvec2 offset, dvec2 size, uint shape) {
    precise dvec2 scaled = offset / size;
    dvec4 edge = shapes[shape];
    if (edge.w == 0.0lf) {
        precise double square = scaled.x * scaled.x + scaled.y * scaled.y;
        return min(edge.z * bell_step(0.5lf * (square - 1.0lf) * edge.x), 1.0lf);
    }
    double product = edge.z;
    for (uint side = 0u; side < uint(edge.w); side += 2u) {
        dvec4 pair = shapes[shape + 1u + side / 2u];
        product *= bell_step((pair.x * scaled.x + pair.y * scaled.y - edge.y) * edge.x);
        if (side + 1u < uint(edge.w)) {
            product *= bell_step((pair.z * scaled.x + pair.w * scaled.y - edge.y) * edge.x);
        }
    }
    return min(product, 1.0lf);
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec4 edge = shapes[shape];
    offset *= inverse_size;
    if (edge.w == 0.0) {
        return min(edge.z / (1.0 + exp(min(0.5 * (dot(offset, offset) - 1.0) * edge.x, 80.0))), 1.0);
    }
    float product = edge.z;
    for (uint side = 0u; side < uint(edge.w); side += 2u) {
        vec4 pair = shapes[shape + 1u + side / 2u];
        float first = 1.0 + exp(min((dot(pair.xy, offset) - edge.y) * edge.x, 80.0));
        float second = side + 1u < uint(edge.w) ? 1.0 + exp(min((dot(pair.zw, offset) - edge.y) * edge.x, 80.0)) : 1.0;
        product /= first;
        product /= second;
    }
    return min(product, 1.0);
}
#endif

// The opening of a lens with a smooth edge: a product of logistic steps, one for each side, or one step of the radius squared where it
// is round (src/series/iris.rs). The first row of its table has one over the edge, the distance of the sides, what is multiplied, and
// how many sides there are and, 32 for each, cuts; the others have two sides each, and then a cut each: what its exponent has of x, of
// y, of the radius squared, and what is constant.
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
    precise double square = scaled.x * scaled.x + scaled.y * scaled.y;
    dvec4 edge = shapes[shape];
    uint sides = uint(edge.w) % 32u, cuts = uint(edge.w) / 32u;
    double product = edge.z;
    if (sides == 0u) product *= bell_step(0.5lf * (square - 1.0lf) * edge.x);
    for (uint side = 0u; side < sides; side += 2u) {
        dvec4 pair = shapes[shape + 1u + side / 2u];
        product *= bell_step((pair.x * scaled.x + pair.y * scaled.y - edge.y) * edge.x);
        if (side + 1u < sides) {
            product *= bell_step((pair.z * scaled.x + pair.w * scaled.y - edge.y) * edge.x);
        }
    }
    for (uint cut = 0u; cut < cuts; ++cut) {
        dvec4 rim = shapes[shape + 1u + (sides + 1u) / 2u + cut];
        product *= bell_step((rim.z * square - rim.x * scaled.x - rim.y * scaled.y + rim.w) * edge.x);
    }
    return min(product, 1.0lf);
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec4 edge = shapes[shape];
    offset *= inverse_size;
    float square = dot(offset, offset);
    uint sides = uint(edge.w) % 32u, cuts = uint(edge.w) / 32u;
    float product = edge.z;
    if (sides == 0u) product /= 1.0 + exp(min(0.5 * (square - 1.0) * edge.x, 80.0));
    for (uint side = 0u; side < sides; side += 2u) {
        vec4 pair = shapes[shape + 1u + side / 2u];
        float first = 1.0 + exp(min((dot(pair.xy, offset) - edge.y) * edge.x, 80.0));
        float second = side + 1u < sides ? 1.0 + exp(min((dot(pair.zw, offset) - edge.y) * edge.x, 80.0)) : 1.0;
        product /= first;
        product /= second;
    }
    for (uint cut = 0u; cut < cuts; ++cut) {
        vec4 rim = shapes[shape + 1u + (sides + 1u) / 2u + cut];
        product /= 1.0 + exp(min((rim.z * square - dot(rim.xy, offset) + rim.w) * edge.x, 80.0));
    }
    return min(product, 1.0);
}
#endif

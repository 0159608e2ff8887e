// The round disc, 1 within a rim of some width, across which it falls by a smoothstep, and 0 beyond; a rim that is no width at
// all belongs to it. Its coefficients come from a table.
#include "shared/shapes.glsl"

#ifdef DOUBLE
double bell_value(dvec2 offset, dvec2 size, uint shape) {
    precise dvec2 scaled = offset / size;
    // No product and sum in one, which would round once where the reference rounds twice.
    precise double square = scaled.x * scaled.x + scaled.y * scaled.y;
    precise double radius = sqrt(square);
    dvec2 rim = shapes[shape].xy; // where it ends, and one over its width
    if (rim.y == 0.0lf) {
        return radius <= 1.0lf ? 1.0lf : 0.0lf;
    }
    precise double within = (rim.x - radius) * rim.y;
    within = clamp(within, 0.0lf, 1.0lf);
    return within * within * (3.0lf - 2.0lf * within);
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec2 rim = shapes[shape].xy;
    float radius = length(offset * inverse_size);
    float within = clamp((rim.x - radius) * rim.y, 0.0, 1.0);
    return rim.y == 0.0 ? float(radius <= 1.0) : within * within * (3.0 - 2.0 * within);
}
#endif

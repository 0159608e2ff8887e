// The disc of an opening with blades: as the round one, of a polygon's radius (src/series/disc.rs). The second row of its table
// has two mirrors, which leave no more than a quarter of the upper half; the third has two sides.
#include "shared/shapes.glsl"

#ifdef DOUBLE
double bell_value(dvec2 offset, dvec2 size, uint shape) {
    precise dvec2 scaled = offset / size;
    dvec4 rim = shapes[shape]; // where it ends, one over its width, cosine and sine of the rotation
    dvec4 mirrors = shapes[shape + 1u], sides = shapes[shape + 2u];
    // No product and sum in one, which would round once where the reference rounds twice.
    precise double x = rim.z * scaled.x + rim.w * scaled.y;
    precise double y = abs(rim.z * scaled.y - rim.w * scaled.x);
    precise double beyond = max(mirrors.x * x + mirrors.y * y, 0.0lf);
    precise double u = x - beyond * mirrors.x, v = y - beyond * mirrors.y;
    precise double again = max(mirrors.z * u + mirrors.w * v, 0.0lf);
    precise double s = u - again * mirrors.z, t = v - again * mirrors.w;
    precise double first = sides.x * s + sides.y * t;
    precise double second = sides.z * s + sides.w * t;
    double radius = max(first, second);
    if (rim.y == 0.0lf) {
        return radius <= 1.0lf ? 1.0lf : 0.0lf;
    }
    precise double within = (rim.x - radius) * rim.y;
    within = clamp(within, 0.0lf, 1.0lf);
    return within * within * (3.0lf - 2.0lf * within);
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec4 rim = shapes[shape], mirrors = shapes[shape + 1u], sides = shapes[shape + 2u];
    offset *= inverse_size;
    vec2 at = vec2(dot(rim.zw, offset), abs(rim.z * offset.y - rim.w * offset.x));
    at -= max(dot(mirrors.xy, at), 0.0) * mirrors.xy;
    at -= max(dot(mirrors.zw, at), 0.0) * mirrors.zw;
    float radius = max(dot(sides.xy, at), dot(sides.zw, at));
    float within = clamp((rim.x - radius) * rim.y, 0.0, 1.0);
    return rim.y == 0.0 ? float(radius <= 1.0) : within * within * (3.0 - 2.0 * within);
}
#endif

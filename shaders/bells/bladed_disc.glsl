// The disc of an opening with blades: as the round one, of a polygon's radius (src/series/disc.rs). The second to fifth row of
// its table are the sides of its upper half, two a row: always eight, so that there is no loop to be counted.
#include "shared/shapes.glsl"

#ifdef DOUBLE
double sides(dvec4 two, double x, double y) {
    precise double first = two.x * x + two.y * y;
    precise double second = two.z * x + two.w * y;
    return max(first, second);
}

double bell_value(dvec2 offset, dvec2 size, uint shape) {
    precise dvec2 scaled = offset / size;
    dvec4 rim = shapes[shape]; // where it ends, one over its width, cosine and sine of the rotation
    // No product and sum in one, which would round once where the reference rounds twice.
    precise double x = rim.z * scaled.x + rim.w * scaled.y;
    precise double y = abs(rim.z * scaled.y - rim.w * scaled.x);
    double radius = max(max(sides(shapes[shape + 1u], x, y), sides(shapes[shape + 2u], x, y)),
                        max(sides(shapes[shape + 3u], x, y), sides(shapes[shape + 4u], x, y)));
    if (rim.y == 0.0lf) {
        return radius <= 1.0lf ? 1.0lf : 0.0lf;
    }
    precise double within = (rim.x - radius) * rim.y;
    within = clamp(within, 0.0lf, 1.0lf);
    return within * within * (3.0lf - 2.0lf * within);
}
#else
float sides(vec4 two, vec2 at) {
    return max(dot(two.xy, at), dot(two.zw, at));
}

float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec4 rim = shapes[shape];
    offset *= inverse_size;
    vec2 at = vec2(dot(rim.zw, offset), abs(rim.z * offset.y - rim.w * offset.x));
    float radius = max(max(sides(shapes[shape + 1u], at), sides(shapes[shape + 2u], at)),
                       max(sides(shapes[shape + 3u], at), sides(shapes[shape + 4u], at)));
    float within = clamp((rim.x - radius) * rim.y, 0.0, 1.0);
    return rim.y == 0.0 ? float(radius <= 1.0) : within * within * (3.0 - 2.0 * within);
}
#endif

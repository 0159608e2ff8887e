// A radial profile, linear in r^2 between the rows of its table; its coefficients come from another table.
#include "shared/shapes.glsl"

// The row at or before the radius; the rows' r^2 or, in 64-bit floats, their r: by that the reference finds its row, and a
// pixel on a rim is to fall on the same side. There are no more rows than so many halvings find.
#ifdef DOUBLE
uint row_before(double radius, uint low, uint high) {
#define row_at(row) shapes[row].w
#else
uint row_before(float radius, uint low, uint high) {
#define row_at(row) shapes[row].x
#endif
    for (uint step = 0u; step < PROFILE_HALVINGS; ++step) {
        uint middle = (low + high + 1u) / 2u;
        bool later = row_at(middle) > radius;
        high = later ? middle - 1u : high;
        low = later ? low : middle;
    }
    return low;
}

#ifdef DOUBLE
double bell_value(dvec2 offset, dvec2 size, uint shape) {
    precise dvec2 scaled = offset / size;
    // No product and sum in one, which would round once where the reference rounds twice.
    precise double square = scaled.x * scaled.x + scaled.y * scaled.y;
    precise double radius = sqrt(square);
    uint low = shape + 1u, high = shape + uint(shapes[shape].x);
    if (radius > shapes[high].w) {
        return 0.0lf;
    }
    dvec4 row = shapes[row_before(radius, low, high)];
    precise double again = radius * radius;
    return row.y + row.z * (again - row.x);
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    offset *= inverse_size;
    float square = dot(offset, offset);
    uint low = shape + 1u, high = shape + uint(shapes[shape].x);
    if (square > shapes[high].x) {
        return 0.0;
    }
    vec4 row = shapes[row_before(square, low, high)];
    return row.y + row.z * (square - row.x);
}
#endif

// A radial profile, linear in r^2 between the rows of its table; its coefficients come from another table.
#include "shared/shapes.glsl"

float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    offset *= inverse_size;
    float square = dot(offset, offset);
    uint count = uint(shapes[shape].x);
    uint low = shape + 1u, high = shape + count;
    if (square > shapes[high].x) {
        return 0.0;
    }
    // The row at or before the radius: at most 4096 rows, so 12 halvings.
    for (uint step = 0u; step < 12u; ++step) {
        uint middle = (low + high + 1u) / 2u;
        bool later = shapes[middle].x > square;
        high = later ? middle - 1u : high;
        low = later ? low : middle;
    }
    vec4 row = shapes[low];
    return row.y + row.z * (square - row.x);
}

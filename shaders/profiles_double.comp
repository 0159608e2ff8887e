// `profiles` in 64-bit floats.
#include "shared/spectrum_double.glsl"
#include "shared/waves.glsl"

layout(local_size_x = DOUBLE_GROUP) in;
layout(std430, binding = BINDING_SUMS) writeonly buffer Profiles {
    dvec2 profiles[]; // (P, Q) of red, green, blue: harmonic by harmonic, row by row
};

void main() {
    int row = int(gl_GlobalInvocationID.x), n = int(gl_GlobalInvocationID.y), rows = int(wave_head.x);
    if (row >= rows) {
        return;
    }
    int begin = int(offsets[n]), count = int(offsets[n + 1]) - begin;
    dvec2 red = dvec2(0.0lf), green = dvec2(0.0lf), blue = dvec2(0.0lf);
    for (int m = 0; m < count; ++m) {
        dvec2 y = waves[m * rows + row];
        int term = 6 * (begin + m);
        red += dvec2(dot(halves[term], y), dot(halves[term + 1], y));
        green += dvec2(dot(halves[term + 2], y), dot(halves[term + 3], y));
        blue += dvec2(dot(halves[term + 4], y), dot(halves[term + 5], y));
    }
    int profile = 3 * (row * int(row_count) + n);
    profiles[profile] = red;
    profiles[profile + 1] = green;
    profiles[profile + 2] = blue;
}

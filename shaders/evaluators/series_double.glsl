// `series` in 64-bit floats.
#include "shared/spectrum_double.glsl"
#include "shared/waves.glsl"

layout(std430, binding = BINDING_SUMS) readonly buffer WavesAcross {
    uvec4 across_head;
    dvec2 waves_across[]; // of y, as `waves` are of x
};

dvec3 glare(ivec2 pixel) {
    double red = 0.0lf, green = 0.0lf, blue = 0.0lf;
    int rows = int(row_count), columns = int(wave_head.x), lines = int(across_head.x);
    for (int n = 0; n < rows; ++n) {
        dvec2 x = waves[n * columns + pixel.x];
        int begin = int(offsets[n]), count = int(offsets[n + 1]) - begin;
        for (int m = 0; m < count; ++m) {
            dvec2 y = waves_across[m * lines + pixel.y];
            int term = 6 * (begin + m);
            red += x.x * dot(halves[term], y) + x.y * dot(halves[term + 1], y);
            green += x.x * dot(halves[term + 2], y) + x.y * dot(halves[term + 3], y);
            blue += x.x * dot(halves[term + 4], y) + x.y * dot(halves[term + 5], y);
        }
    }
    return dvec3(red, green, blue);
}

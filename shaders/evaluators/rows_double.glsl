// `rows` in 64-bit floats, its profiles in a buffer.
#include "shared/spectrum_double.glsl"
#include "shared/waves.glsl"

layout(std430, binding = BINDING_SUMS) readonly buffer Profiles {
    dvec2 profiles[]; // (P, Q) of red, green, blue: harmonic by harmonic, row by row
};

dvec3 glare(ivec2 pixel) {
    double red = 0.0lf, green = 0.0lf, blue = 0.0lf;
    int rows = int(row_count), columns = int(wave_head.x);
    int place = pixel.x, profile = 3 * rows * pixel.y;
    for (int n = 0; n < rows; ++n) {
        dvec2 x = waves[place];
        red += dot(x, profiles[profile]);
        green += dot(x, profiles[profile + 1]);
        blue += dot(x, profiles[profile + 2]);
        place += columns;
        profile += 3;
    }
    return dvec3(red, green, blue);
}

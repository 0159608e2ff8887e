// The parabola 1 - x^2 / h^2 within |x| <= h, and the product of two (docs/math.md, "Parabola").
#include "shared/phase.glsl"

// 3 (sin z - z cos z) / z^3; where that cancels, its series.
float phi(float z) {
    float square = z * z;
    if (z < 1.5) {
        return 1.0 - square / 10.0 * (1.0 - square / 28.0 * (1.0 - square / 54.0 * (1.0 - square / 88.0 *
               (1.0 - square / 130.0 * (1.0 - square / 180.0)))));
    }
    float turns = z * 0.159154943092;
    vec2 circle = cis(uint(fract(turns) * 4294967040.0));
    return 3.0 * (circle.y / z - circle.x) / square;
}

float bell_coefficient(float n, float size) {
    return 4.0 / 3.0 * size * phi(6.28318530718 * n * size);
}

#ifdef DOUBLE
double bell_value(dvec2 offset, dvec2 size, uint shape) {
    offset /= size;
    dvec2 factor = max(1.0lf - offset * offset, 0.0lf);
    return factor.x * factor.y;
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    offset *= inverse_size;
    vec2 factor = max(1.0 - offset * offset, 0.0);
    return factor.x * factor.y;
}
#endif

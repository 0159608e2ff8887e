// The Gaussian exp(-x^2 / 2 sigma^2), a product of one factor for each axis (docs/math.md, "Gaussian").

const float TWO_PI_SQUARED = 19.7392088022;
const float SQRT_TWO_PI = 2.50662827463;

// Mean coefficient of harmonic n of the periodised bell whose sigma is `size` periods.
float bell_coefficient(float n, float size) {
    float turn = n * size;
    return SQRT_TWO_PI * size * exp(-TWO_PI_SQUARED * turn * turn);
}

// The bell at an offset from its centre; `shape` is the first of its rows in `shapes`, where it has any. In 64-bit floats it
// takes the size as it is, as the reference does.
#ifdef DOUBLE
#include "shared/double.glsl"

double bell_value(dvec2 offset, dvec2 size, uint shape) {
    offset /= size;
    return exponential(-0.5lf * dot(offset, offset));
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    offset *= inverse_size;
    return exp(-0.5 * dot(offset, offset));
}
#endif

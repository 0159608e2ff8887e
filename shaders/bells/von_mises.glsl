// The von Mises bell exp(kappa (cos(omega x) - 1)) along each axis; its coefficients come from a table.
#include "shared/shapes.glsl"

float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec2 frequency = shapes[shape].xy; // 1 / T
    // 1 - cos = 2 sin^2(half), which does not cancel.
    vec2 half_sine = sin(3.14159265359 * fract(offset * frequency)) / (6.28318530718 * frequency) * inverse_size;
    return exp(-2.0 * dot(half_sine, half_sine));
}

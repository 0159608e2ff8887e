// The prototype's periodic Gaussian exp(-(sin(omega x) - mu)^2 / 2 (omega sigma)^2) along each axis; its coefficients
// come from a table.
#include "shared/shapes.glsl"

float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec2 frequency = shapes[shape].xy; // 1 / T
    vec2 sine = sin(6.28318530718 * fract(offset * frequency)) - shapes[shape].z;
    vec2 distance = sine / (6.28318530718 * frequency) * inverse_size;
    return exp(-0.5 * dot(distance, distance));
}

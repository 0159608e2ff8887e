// The prototype's periodic Gaussian exp(-(sin(omega x) - mu)^2 / 2 (omega sigma)^2) along each axis; its coefficients
// come from a table.
#include "shared/shapes.glsl"

// Whole periods go before the sine, and its outer quarters are folded in.
#ifdef DOUBLE
#include "shared/double.glsl"

double folded_sine(double turns) {
    turns -= round(turns);
    return sine_of_turns(abs(turns) > 0.25lf ? (turns > 0.0lf ? 0.5lf : -0.5lf) - turns : turns);
}

double bell_value(dvec2 offset, dvec2 size, uint shape) {
    dvec2 frequency = shapes[shape].xy; // 1 / T
    dvec2 turns = offset * frequency;
    dvec2 sine = dvec2(folded_sine(turns.x), folded_sine(turns.y)) - shapes[shape].z;
    dvec2 distance = sine / (6.28318530717958647693lf * frequency * size);
    return exponential(-0.5lf * dot(distance, distance));
}
#else
#include "shared/sine.glsl"

float folded_sine(float turns) {
    turns -= round(turns);
    return sine_of_turns(abs(turns) > 0.25 ? (turns > 0.0 ? 0.5 : -0.5) - turns : turns);
}

float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec2 frequency = shapes[shape].xy; // 1 / T
    vec2 turns = offset * frequency;
    vec2 sine = vec2(folded_sine(turns.x), folded_sine(turns.y)) - shapes[shape].z;
    vec2 distance = sine / (6.28318530718 * frequency) * inverse_size;
    return exp(-0.5 * dot(distance, distance));
}
#endif

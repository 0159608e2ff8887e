// The von Mises bell exp(kappa (cos(omega x) - 1)) along each axis; its coefficients come from a table.
#include "shared/shapes.glsl"

// 1 - cos = 2 sin^2(half), which does not cancel; and whole periods go before the sine, so that it is small where the bell
// is large.
#ifdef DOUBLE
#include "shared/double.glsl"

double bell_value(dvec2 offset, dvec2 size, uint shape) {
    dvec2 frequency = shapes[shape].xy; // 1 / T
    dvec2 turns = offset * frequency;
    turns = 0.5lf * (turns - round(turns));
    dvec2 half_sine = dvec2(sine_of_turns(turns.x), sine_of_turns(turns.y));
    dvec2 distance = half_sine / (6.28318530717958647693lf * frequency * size);
    return exponential(-2.0lf * dot(distance, distance));
}
#else
#include "shared/sine.glsl"

float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    vec2 frequency = shapes[shape].xy; // 1 / T
    vec2 turns = offset * frequency;
    turns = 0.5 * (turns - round(turns));
    vec2 half_sine = vec2(sine_of_turns(turns.x), sine_of_turns(turns.y));
    vec2 distance = half_sine / (6.28318530718 * frequency) * inverse_size;
    return exp(-2.0 * dot(distance, distance));
}
#endif

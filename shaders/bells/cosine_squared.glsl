// The cosine-squared bell, cos^2(pi x / 2 h) within |x| <= h (docs/math.md, "Cosine squared").
#include "shared/phase.glsl"

float bell_coefficient(float n, float size) {
    float s = 2.0 * n * size;
    // sin(pi t) / (pi t) at t = s, or past the singularity at s = 1; in turns, so that nothing grows with n.
    float t = s < 0.5 ? s : s - 1.0;
    float half_turns = t - 2.0 * floor(0.5 * t);
    float sinc = abs(t) < 1e-4 ? 1.0 : cis(uint(half_turns * 2147483648.0)).y / (3.14159265359 * t);
    return size * sinc / (s < 0.5 ? (1.0 - s) * (1.0 + s) : s * (1.0 + s));
}

#ifdef DOUBLE
#include "shared/double.glsl"

double bell_value(dvec2 offset, dvec2 size, uint shape) {
    offset = abs(offset / size);
    if (max(offset.x, offset.y) >= 1.0lf) {
        return 0.0lf;
    }
    double cosines = sine_of_turns(0.25lf * (1.0lf - offset.x)) * sine_of_turns(0.25lf * (1.0lf - offset.y));
    return cosines * cosines;
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    offset = abs(offset * inverse_size);
    if (max(offset.x, offset.y) >= 1.0) {
        return 0.0;
    }
    vec2 cosine = cos(1.57079632679 * offset);
    return cosine.x * cosine.x * cosine.y * cosine.y;
}
#endif

// Every bell, each by its name, for scenes that have several kinds.

#define bell_coefficient gaussian_coefficient
#define bell_value gaussian
#include "bells/gaussian.glsl"
#undef bell_coefficient
#undef bell_value
#define bell_coefficient cosine_squared_coefficient
#define bell_value cosine_squared
#include "bells/cosine_squared.glsl"
#undef bell_coefficient
#undef bell_value
#define bell_coefficient parabola_coefficient
#define bell_value parabola
#include "bells/parabola.glsl"
#undef bell_coefficient
#undef bell_value
#define bell_value paraboloid
#include "bells/paraboloid.glsl"
#undef bell_value
#define bell_value von_mises
#include "bells/von_mises.glsl"
#undef bell_value
#define bell_value sine_gaussian
#include "bells/sine_gaussian.glsl"
#undef bell_value
#define bell_value profile
#include "bells/profile.glsl"
#undef bell_value

// RUN(kind, function) for each of them, in the order of the registry.
#define EACH_BELL(RUN) \
    RUN(0, gaussian) \
    RUN(1, cosine_squared) \
    RUN(2, parabola) \
    RUN(3, paraboloid) \
    RUN(4, von_mises) \
    RUN(5, sine_gaussian) \
    RUN(6, profile)

#ifdef DOUBLE
#define real double
#define reals dvec2
#else
#define real float
#define reals vec2
#endif

// For where there is no list of each kind: the kind, in the order of the registry, is in the highest bits of `bell`; the size
// as the bells take it. Mesa's software renderer computes all of them, whatever the kind.
real bell_value(reals offset, reals size, uint bell) {
    uint shape = bell & ((1u << KIND_SHIFT) - 1u);
    switch (bell >> KIND_SHIFT) {
    case 0u: return gaussian(offset, size, shape);
    case 1u: return cosine_squared(offset, size, shape);
    case 2u: return parabola(offset, size, shape);
    case 3u: return paraboloid(offset, size, shape);
    case 4u: return von_mises(offset, size, shape);
    case 5u: return sine_gaussian(offset, size, shape);
    case 6u: return profile(offset, size, shape);
    }
    return real(0.0);
}

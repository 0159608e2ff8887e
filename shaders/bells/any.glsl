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
#define bell_value disc
#include "bells/disc.glsl"
#undef bell_value
#define bell_value bladed_disc
#include "bells/bladed_disc.glsl"
#undef bell_value

// RUN(kind, function) for each of them, in the order of the registry. There is no function that chooses a ghost's bell: Mesa's
// software renderer would compute all of them for each ghost.
#define EACH_BELL(RUN) \
    RUN(0, gaussian) \
    RUN(1, cosine_squared) \
    RUN(2, parabola) \
    RUN(3, paraboloid) \
    RUN(4, von_mises) \
    RUN(5, sine_gaussian) \
    RUN(6, profile) \
    RUN(7, disc) \
    RUN(8, bladed_disc)

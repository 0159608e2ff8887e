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
#define bell_value iris
#include "bells/iris.glsl"
#undef bell_value

// RUN(kind, function) for each of them that the program HAS, in the order of the registry. There is no function that chooses a
// ghost's bell: Mesa's software renderer would compute all of them for each ghost. Nor is there a loop for a bell that no ghost
// has: it would go through it once.
#ifdef HAS_0
#define RUN_0(RUN) RUN(0, gaussian)
#else
#define RUN_0(RUN)
#endif
#ifdef HAS_1
#define RUN_1(RUN) RUN(1, cosine_squared)
#else
#define RUN_1(RUN)
#endif
#ifdef HAS_2
#define RUN_2(RUN) RUN(2, parabola)
#else
#define RUN_2(RUN)
#endif
#ifdef HAS_3
#define RUN_3(RUN) RUN(3, paraboloid)
#else
#define RUN_3(RUN)
#endif
#ifdef HAS_4
#define RUN_4(RUN) RUN(4, von_mises)
#else
#define RUN_4(RUN)
#endif
#ifdef HAS_5
#define RUN_5(RUN) RUN(5, sine_gaussian)
#else
#define RUN_5(RUN)
#endif
#ifdef HAS_6
#define RUN_6(RUN) RUN(6, profile)
#else
#define RUN_6(RUN)
#endif
#ifdef HAS_7
#define RUN_7(RUN) RUN(7, disc)
#else
#define RUN_7(RUN)
#endif
#ifdef HAS_8
#define RUN_8(RUN) RUN(8, bladed_disc)
#else
#define RUN_8(RUN)
#endif
#ifdef HAS_9
#define RUN_9(RUN) RUN(9, iris)
#else
#define RUN_9(RUN)
#endif
#define EACH_BELL(RUN) RUN_0(RUN) RUN_1(RUN) RUN_2(RUN) RUN_3(RUN) RUN_4(RUN) RUN_5(RUN) RUN_6(RUN) RUN_7(RUN) RUN_8(RUN) RUN_9(RUN)

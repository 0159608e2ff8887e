// A series and a direct sum, or one of the two, and beside them what is drawn where it reaches.
#define glare series_glare
#include SERIES
#undef glare
#define glare direct_glare
#include DIRECT
#undef glare
#define glare local_glare
#include "evaluators/local.glsl"
#undef glare

vec3 glare(ivec2 pixel) {
    return series_glare(pixel) + direct_glare(pixel) + local_glare(pixel);
}

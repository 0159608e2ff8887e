// A series of most ghosts, and beside it the direct sum of a few.
#define glare series_glare
#include SERIES
#undef glare
#define glare direct_glare
#include DIRECT
#undef glare

vec3 glare(ivec2 pixel) {
    return series_glare(pixel) + direct_glare(pixel);
}

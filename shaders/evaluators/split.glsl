// A series of most ghosts, and beside it the direct sum of a few; one of 64-bit floats makes their sum one of them.
#define glare series_glare
#include SERIES
#undef glare
#define glare direct_glare
#include DIRECT
#undef glare

#ifdef EXACT
dvec3 glare(ivec2 pixel) {
#else
vec3 glare(ivec2 pixel) {
#endif
    return series_glare(pixel) + direct_glare(pixel);
}

// A series and a direct sum, or one of the two, and beside them what is drawn where it reaches; one of 64-bit floats
// makes their sum one of them.
#define glare series_glare
#include SERIES
#undef glare
#define glare direct_glare
#include DIRECT
#undef glare
#define glare local_glare
#include LOCAL
#undef glare

#ifdef EXACT
dvec3 glare(ivec2 pixel) {
#else
vec3 glare(ivec2 pixel) {
#endif
    return series_glare(pixel) + direct_glare(pixel) + local_glare(pixel);
}

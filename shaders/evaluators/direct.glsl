// `direct`: the bells themselves, summed at every pixel (rex's non-parametric case). The cost of a pixel grows with K.
#include BELL

struct Ghost {
    vec2 center;
    vec2 inverse_size;
    float red, green, blue; // radiance
    uint bell;              // where its parameters begin
};
#ifdef MANY_GHOSTS
layout(std430, binding = BINDING_GHOSTS) readonly buffer Ghosts {
    Ghost ghosts[];
};
// A fixed number of rounds, which compilers unroll: Mesa's software renderer ends every loop once a pixel has gone
// through 65535 rounds in all.
const uint STEP = DIRECT_STEP;
#else
// As many as fit 64 KiB. All pixels read the same ghost at once, which uniforms are made for: on Mesa's software renderer
// this is 3 to 5 times as fast as a storage buffer, but only if the loop is not unrolled.
layout(std140, binding = BINDING_FEW_GHOSTS) uniform Ghosts {
    Ghost ghosts[DIRECT_FEW_BYTES / 32];
};
const uint STEP = 1u;
#endif
layout(std140, binding = BINDING_DIRECT) uniform Direct {
    ivec2 corner;   // of the tile, in pixels of the picture
    ivec2 size;     // of the picture, in pixels
    uint ghost_count; // a multiple of STEP; the last ones of each kind may have no weight
    vec2 unit;      // half a pixel's width and height
    uvec4 aspect;   // of `direct_double`
    uvec4 runs[DIRECT_RUNS / 4]; // where the ghosts of each kind of bell begin, and where the last of them end
};

// Adds the ghosts of one bell. A loop for each: where a bell were chosen for each ghost, Mesa's software renderer would
// compute all of them for every one. Batches are summed with what each addition lost (Kahan), so that rounding does not grow
// with K.
#define SUM(bell_of, begin, end) \
    for (uint base = begin; base < end; base += DIRECT_BATCH) { \
        vec3 batch = vec3(0.0); \
        uint last = min(base + DIRECT_BATCH, end); \
        for (uint first = base; first < last; first += STEP) { \
            for (uint k = 0u; k < STEP; ++k) { \
                Ghost ghost = ghosts[first + k]; \
                vec3 weight = vec3(ghost.red, ghost.green, ghost.blue); \
                batch += weight * bell_of(position - ghost.center, ghost.inverse_size, ghost.bell); \
            } \
        } \
        precise vec3 addend = batch - lost; \
        precise vec3 next = sum + addend; \
        lost = (next - sum) - addend; \
        sum = next; \
    }
#define RUN(kind, bell_of) SUM(bell_of, runs[kind / 4][kind % 4], runs[(kind + 1) / 4][(kind + 1) % 4])

vec3 glare(ivec2 pixel) {
    ivec2 p = corner + pixel;
    // Integers up to the product, which GLSL rounds correctly as it need not a quotient: two roundings in all.
    vec2 position = vec2(ivec2(2 * p.x + 1 - size.x, size.y - 2 * p.y - 1)) * unit;
    precise vec3 sum = vec3(0.0), lost = vec3(0.0);
#ifdef EACH_BELL
    EACH_BELL(RUN)
#else
    SUM(bell_value, 0u, ghost_count)
#endif
    return sum;
}

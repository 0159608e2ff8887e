// `direct` in 64-bit floats from the pixel's position to the sum: for what 32 bits would move or lose, a steep flank, a bell
// far from the picture for its size, light that cancels. The formulas, and their order, are those of `frame` and
// `reference`, so that a pixel on a rim falls on the same side of it.
#include BELL

struct Ghost {
    dvec2 center;
    dvec2 size;
    double red, green, blue; // radiance
    uint bell;               // where its parameters begin
    uint pad;
};
// As in `direct`, with half as many that fit 64 KiB.
#ifdef MANY_GHOSTS
layout(std430, binding = BINDING_GHOSTS) readonly buffer Ghosts {
    Ghost ghosts[];
};
const uint STEP = DIRECT_STEP;
#else
layout(std140, binding = BINDING_FEW_GHOSTS) uniform Ghosts {
    Ghost ghosts[DIRECT_FEW_BYTES / 64];
};
const uint STEP = 1u;
#endif
layout(std140, binding = BINDING_DIRECT) uniform Direct {
    ivec2 corner;   // of the tile, in pixels of the picture
    ivec2 size;     // of the picture, in pixels
    uint ghost_count; // a multiple of STEP; the last ones of each kind may have no weight
    vec2 unit;      // of `direct`
    double aspect;  // a pixel's width over its height
    double length_unit; // the unit of lengths, in half picture heights
    uvec4 runs[DIRECT_RUNS / 4]; // where the ghosts of each kind of bell begin, and where the last of them end
};

// Adds the ghosts of one bell, as in `direct`.
#define SUM(bell_of, begin, end) \
    for (uint base = begin; base < end; base += DIRECT_BATCH) { \
        uint last = min(base + DIRECT_BATCH, end); \
        for (uint first = base; first < last; first += STEP) { \
            for (uint k = 0u; k < STEP; ++k) { \
                Ghost ghost = ghosts[first + k]; \
                precise dvec2 offset = dvec2(x, y) - ghost.center; \
                double value = bell_of(offset, ghost.size, ghost.bell); \
                red += ghost.red * value; \
                green += ghost.green * value; \
                blue += ghost.blue * value; \
            } \
        } \
    }
#define RUN(kind, bell_of) SUM(bell_of, runs[kind / 4][kind % 4], runs[(kind + 1) / 4][(kind + 1) % 4])

dvec3 glare(ivec2 pixel) {
    ivec2 p = corner + pixel;
    precise double tall = double(size.y) * length_unit;
    precise double x = aspect * double(2 * p.x + 1 - size.x) / tall;
    precise double y = double(size.y - 2 * p.y - 1) / tall;
    double red = 0.0lf, green = 0.0lf, blue = 0.0lf;
#ifdef EACH_BELL
    EACH_BELL(RUN)
#else
    SUM(bell_value, 0u, ghost_count)
#endif
    return dvec3(red, green, blue);
}

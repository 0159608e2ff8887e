// The spectrum of one group of ghosts: each work group sums a slice of the ghosts into a tile of TILE x TILE modes.
//
//     A += w a_n a_m cos(n w1 x_k) cos(m w2 y_k)   and so on for B, C, D
//
// The factors of a ghost depend on n or on m alone. An invocation has one n, whose factor it computes itself, and MINE
// of the tile's m, whose factors a work group prepares for a batch of ghosts in shared memory. More than four would be
// faster for many ghosts on Mesa's software renderer, but take it too long to compile. Sums nest three deep (batch,
// slice, all), which keeps f32 rounding small even where a million equal weights add up.
#include "shared/phase.glsl"
#include "shared/spectrum.glsl"
#include BELL

const uint TILE = SPECTRUM_TILE;
const uint BATCH = SPECTRUM_BATCH;
const uint MINE = SPECTRUM_MINE;
layout(local_size_x = SPECTRUM_TILE, local_size_y = SPECTRUM_ROWS) in;

struct Ghost {
    uvec2 phase; // centre, in 2^-32 of a period
    vec2 size;   // in periods
    vec4 weight; // radiance; w unused
};
layout(std430, binding = BINDING_GHOSTS) readonly buffer Ghosts {
    Ghost ghosts[];
};
layout(std430, binding = BINDING_PARTIALS) writeonly buffer Partials {
    vec4 partials[]; // 3 a mode, tile after tile, slice after slice
};
layout(std140, binding = BINDING_PASS) uniform Pass {
    uint ghost_count;
    uint slice_length;
    uvec2 degree;
};

shared vec2 factors_y[BATCH * TILE];

vec2 factor(uint harmonic, uint phase, float size) {
    return bell_coefficient(float(harmonic), size) * cis(harmonic * phase);
}

void store(uvec2 mode, vec4 red, vec4 green, vec4 blue) {
    uvec2 modes = gl_NumWorkGroups.xy * TILE;
    uint partial = 3u * ((gl_WorkGroupID.z * modes.y + mode.y) * modes.x + mode.x);
    partials[partial] = red;
    partials[partial + 1u] = green;
    partials[partial + 2u] = blue;
}

void main() {
    uint first = gl_WorkGroupID.z * slice_length;
    uint last = min(first + slice_length, ghost_count);
    uint lane = gl_LocalInvocationID.x;
    uint n = gl_WorkGroupID.x * TILE + lane;
    uint m = gl_WorkGroupID.y * TILE;
    uint own = gl_LocalInvocationID.y * MINE;
    // Rows get no longer with n, so this tile has no mode that is kept.
    if (gl_WorkGroupID.x * TILE > degree.x || m >= term_count(gl_WorkGroupID.x * TILE)) {
        return;
    }
    vec4 red[MINE], green[MINE], blue[MINE];
    for (uint t = 0u; t < MINE; ++t) {
        red[t] = green[t] = blue[t] = vec4(0.0);
    }
    for (uint base = first; base < last; base += BATCH) {
        uint count = min(BATCH, last - base);
        for (uint g = gl_LocalInvocationID.y; g < count; g += TILE / MINE) {
            factors_y[g * TILE + lane] = factor(m + lane, ghosts[base + g].phase.y, ghosts[base + g].size.y);
        }
        barrier();
        vec4 batch_red[MINE], batch_green[MINE], batch_blue[MINE];
        for (uint t = 0u; t < MINE; ++t) {
            batch_red[t] = batch_green[t] = batch_blue[t] = vec4(0.0);
        }
        for (uint g = 0u; g < count; ++g) {
            Ghost ghost = ghosts[base + g];
            vec2 x = factor(n, ghost.phase.x, ghost.size.x);
            vec4 xr = (ghost.weight.r * x).xxyy, xg = (ghost.weight.g * x).xxyy, xb = (ghost.weight.b * x).xxyy;
            for (uint t = 0u; t < MINE; ++t) {
                vec4 y = factors_y[g * TILE + own + t].xyxy;
                batch_red[t] += xr * y;
                batch_green[t] += xg * y;
                batch_blue[t] += xb * y;
            }
        }
        for (uint t = 0u; t < MINE; ++t) {
            red[t] += batch_red[t];
            green[t] += batch_green[t];
            blue[t] += batch_blue[t];
        }
        barrier();
    }
    for (uint t = 0u; t < MINE; ++t) {
        store(uvec2(n, m + own + t), red[t], green[t], blue[t]);
    }
}

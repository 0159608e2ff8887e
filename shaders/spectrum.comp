// The spectrum of one group of ghosts: each work group sums a slice of the ghosts into a tile of 8 x 8 modes.
//
//     A += w a_n a_m cos(n w1 x_k) cos(m w2 y_k)   and so on for B, C, D
//
// The factors of a ghost depend on n or on m alone, so a batch of ghosts is prepared once in shared memory, 8 + 8
// factors a ghost, and then multiplied out. Sums nest three deep (batch, slice, all), which keeps f32 rounding small
// even where a million equal weights add up.
#include "shared/phase.glsl"
#include BELL

const uint TILE = 8u;
const uint BATCH = 32u;
layout(local_size_x = 8, local_size_y = 8) in;

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
    uint pad0;
    uint pad1;
};

shared vec2 factors_x[BATCH * TILE];
shared vec2 factors_y[BATCH * TILE];
shared vec3 weights[BATCH];

vec2 factor(uint harmonic, uint phase, float size) {
    return bell_coefficient(float(harmonic), size) * cis(harmonic * phase);
}

void prepare(uint first, uint last) {
    for (uint entry = gl_LocalInvocationIndex; entry < BATCH * TILE; entry += TILE * TILE) {
        uint k = first + entry / TILE;
        uint lane = entry % TILE;
        // Past the slice's last ghost the weight is zero, so these factors only have to be finite.
        Ghost ghost = ghosts[min(k, ghost_count - 1u)];
        factors_x[entry] = factor(gl_WorkGroupID.x * TILE + lane, ghost.phase.x, ghost.size.x);
        factors_y[entry] = factor(gl_WorkGroupID.y * TILE + lane, ghost.phase.y, ghost.size.y);
        if (lane == 0u) {
            weights[entry / TILE] = k < last ? ghost.weight.rgb : vec3(0.0);
        }
    }
}

void main() {
    uint first = gl_WorkGroupID.z * slice_length;
    uint last = min(first + slice_length, ghost_count);
    vec4 red = vec4(0.0), green = vec4(0.0), blue = vec4(0.0);
    for (uint base = first; base < last; base += BATCH) {
        prepare(base, last);
        barrier();
        vec4 batch_red = vec4(0.0), batch_green = vec4(0.0), batch_blue = vec4(0.0);
        for (uint g = 0u; g < BATCH; ++g) {
            vec2 x = factors_x[g * TILE + gl_LocalInvocationID.x];
            vec2 y = factors_y[g * TILE + gl_LocalInvocationID.y];
            vec4 products = vec4(x.x * y, x.y * y);
            vec3 weight = weights[g];
            batch_red += weight.r * products;
            batch_green += weight.g * products;
            batch_blue += weight.b * products;
        }
        red += batch_red;
        green += batch_green;
        blue += batch_blue;
        barrier();
    }
    uvec2 modes = gl_NumWorkGroups.xy * TILE;
    uint mode = (gl_WorkGroupID.z * modes.y + gl_GlobalInvocationID.y) * modes.x + gl_GlobalInvocationID.x;
    partials[3u * mode] = red;
    partials[3u * mode + 1u] = green;
    partials[3u * mode + 2u] = blue;
}

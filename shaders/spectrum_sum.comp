// Adds a group's slices onto the spectrum: with the weight 1, 2 or 4 that the mode has in the series, or, where the
// group's bell is TABULATED, by the bell's own coefficients (docs/math.md, "Any bell").
#include "shared/spectrum.glsl"

layout(local_size_x = SPECTRUM_TILE, local_size_y = SPECTRUM_TILE) in;
layout(std430, binding = BINDING_PARTIALS) readonly buffer Partials {
    vec4 partials[];
};
#if TABULATED
layout(std430, binding = BINDING_TABLE) readonly buffer Table {
    vec4 table[]; // a mode: what the bell has of c c, s s, c s, s c; the mode's weight included
};
#endif
layout(std140, binding = BINDING_PASS) uniform Pass {
    uvec2 degree;
    uint slices;
    uint pad0;
};

// From the sums of c c, c s, s c, s s of the centres to A, B, C, D.
vec4 shifted(vec4 sum, uvec2 mode) {
#if TABULATED
    vec4 bell = table[offsets[mode.x] + mode.y];
    return bell.x * sum + bell.y * vec4(1.0, -1.0, -1.0, 1.0) * sum.wzyx +
           bell.z * vec4(-1.0, 1.0, -1.0, 1.0) * sum.yxwz + bell.w * vec4(-1.0, -1.0, 1.0, 1.0) * sum.zwxy;
#else
    return (mode.x == 0u ? 1.0 : 2.0) * (mode.y == 0u ? 1.0 : 2.0) * sum;
#endif
}

void main() {
    uvec2 mode = gl_GlobalInvocationID.xy;
    if (any(greaterThan(mode, degree)) || mode.y >= term_count(mode.x)) {
        return;
    }
    uvec2 modes = gl_NumWorkGroups.xy * gl_WorkGroupSize.xy;
    uint term = 3u * (offsets[mode.x] + mode.y);
    for (uint colour = 0u; colour < 3u; ++colour) {
        vec4 sum = vec4(0.0);
        for (uint slice = 0u; slice < slices; ++slice) {
            sum += partials[3u * ((slice * modes.y + mode.y) * modes.x + mode.x) + colour];
        }
        terms[term + colour] += shifted(sum, mode);
    }
}

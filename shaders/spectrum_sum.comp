// Adds a group's slices onto the spectrum, with the weight 1, 2 or 4 that the mode has in the series.
#include "shared/spectrum.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = BINDING_PARTIALS) readonly buffer Partials {
    vec4 partials[];
};
layout(std140, binding = BINDING_PASS) uniform Pass {
    uvec2 degree;
    uint slices;
    uint pad0;
};

void main() {
    uvec2 mode = gl_GlobalInvocationID.xy;
    if (any(greaterThan(mode, degree)) || mode.y >= term_count(mode.x)) {
        return;
    }
    uvec2 modes = gl_NumWorkGroups.xy * gl_WorkGroupSize.xy;
    float kappa = (mode.x == 0u ? 1.0 : 2.0) * (mode.y == 0u ? 1.0 : 2.0);
    uint term = 3u * (offsets[mode.x] + mode.y);
    for (uint colour = 0u; colour < 3u; ++colour) {
        vec4 sum = vec4(0.0);
        for (uint slice = 0u; slice < slices; ++slice) {
            sum += partials[3u * ((slice * modes.y + mode.y) * modes.x + mode.x) + colour];
        }
        terms[term + colour] += kappa * sum;
    }
}

// cos and sin of every harmonic at every position along one axis: texel (i, n) is cis(n * phase[i]).
//
// For a lattice that a cubic B-spline will interpolate, harmonic n is divided by the spline's own response to it,
// (2 + cos theta_n) / 3 at theta_n a step: the prefilter, exact and free (docs/math.md, "Interpolation").
#include "shared/phase.glsl"

layout(std430, binding = BINDING_PHASES) readonly buffer Phases {
    uint phases[];
};
layout(std140, binding = BINDING_PASS) uniform Pass {
    uint prefilter; // 0 or 1
    uint step;      // from node to node, in 2^-32 of a period
    uint pad0;
    uint pad1;
};
layout(location = 0) out vec2 harmonic;

void main() {
    uvec2 texel = uvec2(gl_FragCoord.xy);
    float gain = prefilter == 0u ? 1.0 : 3.0 / (2.0 + cis(texel.y * step).x);
    harmonic = gain * cis(texel.y * phases[texel.x]);
}

// cos and sin of every harmonic at every position along one axis: texel (i, n) is cis(n * phase[i]).
//
// For a lattice that a cubic B-spline will carry, harmonic n is divided by what the spline makes of it between the nodes,
// (sin(theta_n / 2) / (theta_n / 2))^4 at theta_n from node to node: a prefilter, exact and free (docs/math.md,
// "Interpolation").
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

float spline_gain(uint theta) {
    uint phase = theta >> 1; // below a quarter turn, for nodes that oversample at all
    float angle = float(phase) * 1.46291807926715968e-9;
    float sinc = phase == 0u ? 1.0 : cis(phase).y / angle;
    float squared = sinc * sinc;
    return 1.0 / (squared * squared);
}

void main() {
    uvec2 texel = uvec2(gl_FragCoord.xy);
    float gain = prefilter == 0u ? 1.0 : spline_gain(texel.y * step);
    harmonic = gain * cis(texel.y * phases[texel.x]);
}

// Coefficients by sampling, as the prototype's plug-in lays it out: a work group a ghost, an invocation a mode.
//
//     a_n = gain tau / M  sum f(x_i) cos n w x_i     and b_n with sin; tau = 1 for n = 0, else 2
//
// The samples come in a uniform block, four to a vec4: a float array would take 16 bytes for each. Every phase is a whole
// number of 1/M of a turn and is reduced as such. Sums nest two deep, which keeps f32 rounding small.
#include "shared/phase.glsl"

const uint BLOCK = 64u;
layout(local_size_x = COEFFICIENT_MODES) in;

layout(std140, binding = BINDING_PASS) uniform Pass {
    uint sample_count; // of one ghost; M
    uint mode_count;
    uint turns;        // periods that the samples are taken to cover
    uint first_ghost;  // of this dispatch
    float gain;
    float pad0;
    float pad1;
    float pad2;
};
layout(std140, binding = BINDING_SAMPLES) uniform Samples {
    vec4 samples[SAMPLE_VECTORS]; // each ghost begins at a vec4
};
layout(std430, binding = BINDING_PARTIALS) writeonly buffer Coefficients {
    vec2 coefficients[]; // (a_n, b_n), ghost after ghost
};

void main() {
    uint ghost = gl_WorkGroupID.x;
    uint n = gl_WorkGroupID.y * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (n >= mode_count) {
        return;
    }
    // 2^32 / M as a whole number and what is left over: phases to the last bit, without any division of floats.
    uint whole = 0xffffffffu / sample_count;
    uint left = 0xffffffffu % sample_count + 1u;
    uint base = ghost * ((sample_count + 3u) / 4u);
    uint advance = (turns * n) % sample_count;
    uint place = 0u;
    vec2 sum = vec2(0.0);
    for (uint first = 0u; first < sample_count; first += BLOCK) {
        uint last = min(first + BLOCK, sample_count);
        vec2 block = vec2(0.0);
        for (uint i = first; i < last; ++i) {
            uint phase = place * whole + place * left / sample_count;
            block += samples[base + i / 4u][i % 4u] * cis(phase);
            place += advance;
            place -= place >= sample_count ? sample_count : 0u;
        }
        sum += block;
    }
    float tau = n == 0u ? 1.0 : 2.0;
    coefficients[(first_ghost + ghost) * mode_count + n] = gain * tau / float(sample_count) * sum;
}

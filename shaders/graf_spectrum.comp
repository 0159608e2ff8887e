// Adds a batch of ghosts to the Bessel spectrum (docs/math.md, "Fourier-Bessel and Graf"):
//
//     U_km + i V_km += kappa_m a_k sum over ghosts of  w J_m(alpha_k d / L) exp(i m theta)
#include "shared/bessel.glsl"
#include "shared/phase.glsl"

layout(local_size_x = GRAF_LANES) in;
layout(std430, binding = BINDING_GHOSTS) readonly buffer Ghosts {
    uint angles[]; // theta, in 2^-32 of a turn
};
layout(std430, binding = BINDING_SPECTRUM) buffer Spectrum {
    vec2 terms[]; // (U, V), m running fastest
};
layout(std140, binding = BINDING_PASS) uniform Pass {
    uint ghost_count;
    uint orders;      // M + 1
    vec2 first_kappa; // of m = 0 and m = 1; of every other m it is 2
};

void main() {
    uint m = gl_GlobalInvocationID.x;
    uint k = gl_GlobalInvocationID.y;
    if (m >= orders) {
        return;
    }
    vec2 sum = vec2(0.0);
    for (uint ghost = 0u; ghost < ghost_count; ++ghost) {
        vec4 place = texelFetch(places, ivec2(k, ghost), 0); // z: a_k w
        sum += place.z * bessel_j(int(m), place).x * cis(m * angles[ghost]);
    }
    float kappa = m == 0u ? first_kappa.x : m == 1u ? first_kappa.y : 2.0;
    terms[k * orders + m] += kappa * sum;
}

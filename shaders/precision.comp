// The driver's own functions, and vglare's cis, for src/gpu/precision.rs to hold against f64.
#include "shared/phase.glsl"

layout(local_size_x = PRECISION_GROUP) in;
layout(std430, binding = BINDING_ARGUMENTS) readonly buffer Arguments {
    uvec4 arguments[]; // x as bits, harmonic n, phase, unused
};
layout(std430, binding = BINDING_VALUES) writeonly buffer Values {
    vec4 values[]; // two for each: sin x, cos x, exp(-|x|), unused; cos and sin of n times the phase, unused
};

void main() {
    uint k = gl_GlobalInvocationID.x;
    if (k >= uint(arguments.length())) {
        return;
    }
    uvec4 argument = arguments[k];
    float x = uintBitsToFloat(argument.x);
    values[2u * k] = vec4(sin(x), cos(x), exp(-abs(x)), 0.0);
    values[2u * k + 1u] = vec4(cis(argument.y * argument.z), 0.0, 0.0);
}

// The coefficients of all ghosts added up, an invocation a mode. Sums nest two deep.
const uint BLOCK = 64u;
layout(local_size_x = COEFFICIENT_MODES) in;

layout(std140, binding = BINDING_PASS) uniform Pass {
    uint ghost_count;
    uint mode_count;
    uint pad0;
    uint pad1;
};
layout(std430, binding = BINDING_PARTIALS) readonly buffer Coefficients {
    vec2 coefficients[];
};
layout(std430, binding = BINDING_SPECTRUM) writeonly buffer Sums {
    vec2 sums[];
};

void main() {
    uint n = gl_GlobalInvocationID.x;
    if (n >= mode_count) {
        return;
    }
    vec2 sum = vec2(0.0);
    for (uint first = 0u; first < ghost_count; first += BLOCK) {
        uint last = min(first + BLOCK, ghost_count);
        vec2 block = vec2(0.0);
        for (uint ghost = first; ghost < last; ++ghost) {
            block += coefficients[ghost * mode_count + n];
        }
        sum += block;
    }
    sums[n] = sum;
}

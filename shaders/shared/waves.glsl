// cos and sin of every harmonic at every position along an axis, which are computed where f64 has such functions.
layout(std430, binding = BINDING_WAVES) readonly buffer Waves {
    uvec4 wave_head; // x: how many positions there are
    dvec2 waves[];   // harmonic after harmonic
};

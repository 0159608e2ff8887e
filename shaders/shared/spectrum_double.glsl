// The spectrum in 64-bit floats, mode by mode as that of `spectrum`.
layout(std430, binding = BINDING_SPECTRUM) readonly buffer Spectrum {
    dvec2 halves[]; // 6 a mode: (A, B) and (C, D) of red, green, blue
};
layout(std430, binding = BINDING_OFFSETS) readonly buffer Offsets {
    uint row_count; // harmonics of x, 0 included
    uint offsets[]; // where each row begins, and where the last one ends
};

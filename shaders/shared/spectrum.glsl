// The spectrum: for each kept mode (n, m) the four coefficients A, B, C, D of each colour.
//
//     G(x, y) = sum over n, m of  A c_n c_m + B c_n s_m + C s_n c_m + D s_n s_m
//
// Harmonic n of x keeps m = 0 .. term_count(n) - 1; the rows stand one after the other, so that nothing is stored for
// modes that the plan does not need.
layout(std430, binding = BINDING_SPECTRUM) buffer Spectrum {
    vec4 terms[]; // 3 a mode: (A, B, C, D) of red, green, blue
};
layout(std430, binding = BINDING_OFFSETS) readonly buffer Offsets {
    uint row_count; // harmonics of x, 0 included
    uint offsets[]; // where each row begins, and where the last one ends
};

uint term_count(uint n) {
    return offsets[n + 1u] - offsets[n];
}

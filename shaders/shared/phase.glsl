// Cosine and sine of a phase that is a u32 fraction of a turn.
//
// n * phase wraps exactly, so harmonic n costs no accuracy beyond the rounding of the phase itself (docs/math.md,
// "f32 phases"). The quadrant is taken off in integers; what is left, within an eighth of a turn, goes through Taylor
// polynomials whose error (2e-9) is below f32's. No driver's own cos and sin are trusted: GLSL promises nothing of them.
vec2 cis(uint phase) {
    uint quadrant = (phase + 0x20000000u) >> 30;
    float x = float(int(phase - (quadrant << 30))) * 1.46291807926715968e-9; // 2 pi / 2^32
    float z = x * x;
    float c = 1.0 + z * (-0.5 + z * (4.16666667e-2 + z * (-1.38888889e-3 + z * (2.48015873e-5 - z * 2.75573192e-7))));
    float s = x + x * z * (-1.66666667e-1 + z * (8.33333333e-3 + z * (-1.98412698e-4 + z * 2.75573192e-6)));
    vec2 turned = (quadrant & 1u) == 0u ? vec2(c, s) : vec2(-s, c);
    return (quadrant & 2u) == 0u ? turned : -turned;
}

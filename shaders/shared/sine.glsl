// sin(2 pi t) for |t| <= 1/4, with a small relative error: near 0 that is what counts, and GLSL promises none of its own.
float sine_of_turns(float t) {
    float x = 6.28318530718 * t;
    float z = x * x;
    return x - x * z * (1.0 / 6.0 - z * (1.0 / 120.0 - z * (1.0 / 5040.0 - z * (1.0 / 362880.0 - z *
               (1.0 / 39916800.0 - z / 6227020800.0)))));
}

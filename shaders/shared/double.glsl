// The functions that GLSL lacks for 64-bit floats, off by a few units of 1e-15.

// exp(x) for x <= 0.
double exponential(double x) {
    if (x < -700.0lf) {
        return 0.0lf;
    }
    int power = int(round(1.44269504089 * float(x)));
    // ln 2 in two parts, of which the first has room for the power.
    double r = (x - 0.693147180369123816490lf * double(power)) - 1.90821492927058770002e-10lf * double(power);
    // Taylor's polynomial, |r| < 0.35.
    double sum = 1.0lf / 6227020800.0lf;
    sum = sum * r + 1.0lf / 479001600.0lf;
    sum = sum * r + 1.0lf / 39916800.0lf;
    sum = sum * r + 1.0lf / 3628800.0lf;
    sum = sum * r + 1.0lf / 362880.0lf;
    sum = sum * r + 1.0lf / 40320.0lf;
    sum = sum * r + 1.0lf / 5040.0lf;
    sum = sum * r + 1.0lf / 720.0lf;
    sum = sum * r + 1.0lf / 120.0lf;
    sum = sum * r + 1.0lf / 24.0lf;
    sum = sum * r + 1.0lf / 6.0lf;
    sum = sum * r + 0.5lf;
    sum = sum * r + 1.0lf;
    sum = sum * r + 1.0lf;
    return sum * packDouble2x32(uvec2(0u, uint(power + 1023) << 20));
}

// sin(2 pi t) for |t| <= 1/4, with a small relative error: near 0 that is what counts.
double sine_of_turns(double t) {
    double x = 6.28318530717958647693lf * t;
    double z = x * x;
    double sum = 1.0lf / 51090942171709440000.0lf;
    sum = 1.0lf / 121645100408832000.0lf - sum * z;
    sum = 1.0lf / 355687428096000.0lf - sum * z;
    sum = 1.0lf / 1307674368000.0lf - sum * z;
    sum = 1.0lf / 6227020800.0lf - sum * z;
    sum = 1.0lf / 39916800.0lf - sum * z;
    sum = 1.0lf / 362880.0lf - sum * z;
    sum = 1.0lf / 5040.0lf - sum * z;
    sum = 1.0lf / 120.0lf - sum * z;
    sum = 1.0lf / 6.0lf - sum * z;
    return x - x * z * sum;
}

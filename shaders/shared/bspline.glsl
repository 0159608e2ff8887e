// The four weights of the cubic B-spline at a fraction t past the second of four nodes.
vec4 cubic_weights(float t) {
    float u = 1.0 - t;
    float t2 = t * t;
    float u2 = u * u;
    return vec4(u2 * u, 4.0 - 3.0 * t2 * (2.0 - t), 4.0 - 3.0 * u2 * (2.0 - u), t2 * t) / 6.0;
}

struct Knot {
    uint first;     // of the four nodes
    float fraction; // past the second of them
};

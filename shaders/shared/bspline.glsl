// The uniform cubic B-spline between the second and the third of four nodes.

// The weights of the nodes at a fraction t.
vec4 cubic_weights(float t) {
    float u = 1.0 - t;
    float t2 = t * t;
    float u2 = u * u;
    return vec4(u2 * u, 4.0 - 3.0 * t2 * (2.0 - t), 4.0 - 3.0 * u2 * (2.0 - u), t2 * t) / 6.0;
}

// The same as a polynomial: coefficients of 1, t, t^2, t^3.
vec4 cubic_polynomial(vec4 node) {
    return vec4(node.x + 4.0 * node.y + node.z,
                3.0 * (node.z - node.x),
                3.0 * (node.x - 2.0 * node.y + node.z),
                node.w - node.x + 3.0 * (node.y - node.z)) / 6.0;
}

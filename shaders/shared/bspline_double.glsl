// The weights of the nodes that a uniform B-spline of SPLINE_ORDER nodes has at a fraction t of a cell, by the recursion of
// de Boor and Cox.
void spline_weights(double t, out double weights[SPLINE_ORDER]) {
    weights[0] = 1.0lf;
    for (int d = 1; d < SPLINE_ORDER; ++d) {
        double left = 0.0lf;
        for (int r = 0; r < d; ++r) {
            double part = weights[r] / double(d);
            weights[r] = left + (double(r + 1) - t) * part;
            left = (t + double(d - 1 - r)) * part;
        }
        weights[d] = left;
    }
}

// The weights of the eight nodes that a uniform B-spline of degree 7 has at a fraction t of a cell: polynomials in what t is
// past the cell's middle, on either side of which they are mirrored.
void mirrored(double s, double square, dvec4 even, dvec4 odd, out double left, out double right) {
    double e = even.x + square * (even.y + square * (even.z + square * even.w));
    double o = s * (odd.x + square * (odd.y + square * (odd.z + square * odd.w)));
    left = e + o;
    right = e - o;
}

void spline_weights(double t, out double weights[SPLINE_ORDER]) {
    const double part = 1.0lf / 645120.0lf; // 7! times 2^7
    double s = t - 0.5lf;
    double square = s * s;
    mirrored(s, square, part * dvec4(1.0lf, 84.0lf, 560.0lf, 448.0lf),
             part * dvec4(-14.0lf, -280.0lf, -672.0lf, -128.0lf), weights[0], weights[7]);
    mirrored(s, square, part * dvec4(2179.0lf, 19740.0lf, 10640.0lf, -2240.0lf),
             part * dvec4(-10094.0lf, -20440.0lf, -672.0lf, 896.0lf), weights[1], weights[6]);
    mirrored(s, square, part * dvec4(60657.0lf, 101556.0lf, -35280.0lf, 4032.0lf),
             part * dvec4(-137494.0lf, -1400.0lf, 12768.0lf, -2688.0lf), weights[2], weights[5]);
    mirrored(s, square, part * dvec4(259723.0lf, -121380.0lf, 24080.0lf, -2240.0lf),
             part * dvec4(-182070.0lf, 108360.0lf, -30240.0lf, 4480.0lf), weights[3], weights[4]);
}

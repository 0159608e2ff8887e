// The paraboloid 1 - x^2 - y^2 where that is positive; its coefficients come from a table.

#ifdef DOUBLE
double bell_value(dvec2 offset, dvec2 size, uint shape) {
    offset /= size;
    return max(1.0lf - dot(offset, offset), 0.0lf);
}
#else
float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    offset *= inverse_size;
    return max(1.0 - dot(offset, offset), 0.0);
}
#endif

// The paraboloid 1 - x^2 - y^2 where that is positive; its coefficients come from a table.

float bell_value(vec2 offset, vec2 inverse_size, uint shape) {
    offset *= inverse_size;
    return max(1.0 - dot(offset, offset), 0.0);
}

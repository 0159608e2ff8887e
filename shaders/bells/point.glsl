// No bell at all: the sums of cosines and sines of the ghosts' centres, for `spectrum_sum` to multiply by a table.
float bell_coefficient(float n, float size) {
    return 1.0;
}

// Where pixels lie between the lattice's nodes.
//
// In integers: every tile gives a pixel the same place, and there is no table to look up, which on Mesa's software
// renderer would cost more than the interpolation. The lattice's step is the one that its pitch stands for exactly.

struct Knot {
    int first;      // of the four nodes
    float fraction; // past the second of them
    uint bits;      // of that, KNOT_BITS
    uint fine;      // and 16 more
};

// Numbers with KNOT_BITS bits after the point, and 16 more of the first two.
layout(std140, binding = BINDING_EVALUATOR) uniform Knots {
    uvec4 knots_x; // where the first pixel lies, from each to the next, how many nodes there are, and 16 bits more of either
    uvec4 knots_y;
};

Knot knot(uvec4 axis, int pixel) {
    uint fine = (axis.w >> 16) + uint(pixel) * (axis.w & 0xffffu);
    uint place = axis.x + uint(pixel) * axis.y + (fine >> 16);
    const uint one = 1u << KNOT_BITS;
    uint bits = place & (one - 1u);
    fine &= 0xffffu;
    float fraction = (float(int(bits)) + float(int(fine)) * (1.0 / 65536.0)) * (1.0 / float(one));
    return Knot(int(place >> KNOT_BITS), fraction, bits, fine);
}

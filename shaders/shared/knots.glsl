// Where pixels lie between the lattice's nodes.
//
// In integers: every tile gives a pixel the same place, and there is no table to look up, which on Mesa's software
// renderer would cost more than the interpolation. The lattice's step is the one that its pitch stands for exactly.

struct Knot {
    int first;      // of the four nodes
    float fraction; // past the second of them
};

// Numbers with 20 bits after the point.
layout(std140, binding = BINDING_EVALUATOR) uniform Knots {
    uvec4 knots_x; // where the first pixel lies, from each to the next, and how many nodes there are; w unused
    uvec4 knots_y;
};

Knot knot(uvec4 axis, int pixel) {
    uint place = axis.x + uint(pixel) * axis.y;
    return Knot(int(place >> 20), float(int(place & 0xfffffu)) * 9.5367431640625e-7);
}

// Where pixels lie between the lattice's nodes.
//
// In integers: no place is off by more than the last bit, every tile gives a pixel the same place, and there is no table
// to look up, which on Mesa's software renderer would cost half as much as the interpolation itself.

struct Knot {
    int first;      // of the four nodes
    float fraction; // past the second of them
};

// Numbers with 32 bits after the point: whole nodes, then 2^-32 of one.
layout(std140, binding = BINDING_EVALUATOR) uniform Knots {
    uvec4 knots_x; // where the first pixel lies, and from each to the next
    uvec4 knots_y;
};

Knot knot(uvec4 axis, int pixel) {
    uint index = uint(pixel);
    uint whole, part;
    umulExtended(index, axis.w, whole, part);
    uint sum = part + axis.y;
    whole += index * axis.z + axis.x + (sum < part ? 1u : 0u);
    // 24 bits are what a float holds, and come out below 1.
    return Knot(int(whole), float(int(sum >> 8)) * 5.9604644775390625e-8);
}

// The series at the nodes of the lattice, by `rows` in 64-bit floats.
#include "evaluators/rows_double.glsl"

layout(local_size_x = DOUBLE_GROUP) in;
layout(std430, binding = BINDING_NODES) writeonly buffer Nodes {
    double nodes[]; // red, green, blue: node by node, row by row
};

void main() {
    ivec2 node = ivec2(gl_GlobalInvocationID.xy);
    int columns = int(wave_head.x);
    if (node.x >= columns) {
        return;
    }
    dvec3 value = glare(node);
    int place = 3 * (node.y * columns + node.x);
    nodes[place] = value.r;
    nodes[place + 1] = value.g;
    nodes[place + 2] = value.b;
}

// The series at the nodes of the lattice, by `rows`.
#include "field.frag"

// Where pixels lie between the lattice's nodes, in 64-bit floats.
#include "shared/knots.glsl"

double exact_fraction(Knot place) {
    return (double(place.bits) + double(place.fine) * (1.0lf / 65536.0lf)) * (1.0lf / double(1u << KNOT_BITS));
}

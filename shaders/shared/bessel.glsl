// Bessel functions J_m from a table: between two nodes each is a cubic, whose coefficients are a texel.
layout(binding = UNIT_BESSEL) uniform sampler2D bessel; // (m, cell)
// Where to look: (cell, how far into it, what else goes with the place). Prepared in f64, because an argument of some
// hundred leaves f32 only some 1e-5 of a radian.
layout(binding = UNIT_PLACES) uniform sampler2D places; // (k, ghost or radius)

// J_m, and its slope from cell to cell.
vec2 bessel_j(int m, vec4 place) {
    vec4 c = texelFetch(bessel, ivec2(m, int(place.x)), 0);
    float t = place.y;
    return vec2(c.x + t * (c.y + t * (c.z + t * c.w)), c.y + t * (2.0 * c.z + t * 3.0 * c.w));
}

// The cells interpolated along y, at every row of the tile.
#include "shared/bspline.glsl"
#include "shared/knots.glsl"

layout(binding = UNIT_CELLS) uniform sampler2D cells;
layout(location = 0) out vec4 strip;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Knot place = knot(knots_y, texel.y);
    vec4 weights = cubic_weights(place.fraction);
    ivec2 cell = ivec2(texel.x, place.first);
    strip = weights.x * texelFetch(cells, cell, 0) + weights.y * texelFetch(cells, cell + ivec2(0, 1), 0)
          + weights.z * texelFetch(cells, cell + ivec2(0, 2), 0) + weights.w * texelFetch(cells, cell + ivec2(0, 3), 0);
}

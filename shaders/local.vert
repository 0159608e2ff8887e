// A ghost of `local` as what it covers: a point, or a quad of four vertices. All in whole pixels, whose centres lie half a
// pixel within, so that every tile covers the same.
layout(location = 0) in ivec4 area;  // first column and row; after the last ones
layout(location = 1) in ivec2 anchor; // the pixel that is nearest to the centre
layout(location = 2) in vec4 place;  // from the centre to that pixel, and from pixel to pixel, in sizes
layout(location = 3) in vec3 light;
layout(location = 4) in uint kind;   // where its bell's parameters begin, and its kind where there are several
layout(std140, binding = BINDING_PASS) uniform Pass {
    ivec2 corner; // of the tile, in pixels of the picture
    ivec2 size;   // of the tile
    int margin;   // of the viewport, all around the tile
};
flat out vec2 base; // where `gl_FragCoord` is at the anchor
flat out vec4 steps;
flat out vec3 weight;
flat out uint bell;

void main() {
    base = vec2(anchor - corner) + 0.5;
    steps = place;
    weight = light;
    bell = kind;
#ifdef POINTS
    int side = area.z - area.x;
    vec2 vertex = vec2(area.xy - corner) + 0.5 * float(side);
    gl_PointSize = float(side);
#else
    ivec2 corners = ivec2((gl_VertexID & 1) == 0 ? area.x : area.z, (gl_VertexID & 2) == 0 ? area.y : area.w);
    vec2 vertex = vec2(clamp(corners - corner, ivec2(0), size));
#endif
    gl_Position = vec4(2.0 * (vertex + float(margin)) / vec2(size + 2 * margin) - 1.0, 0.0, 1.0);
}

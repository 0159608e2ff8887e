// `local` in 64-bit floats: at each pixel the ghosts that its block of pixels has in its list. The formulas, and their order,
// are those of `frame` and `reference`.
#include BELL

struct Ghost {
    dvec2 center;
    dvec2 size;
    double red, green, blue; // radiance
    uint bell;               // where its parameters begin
    uint pad;
};
layout(std430, binding = BINDING_GHOSTS) readonly buffer Ghosts {
    Ghost ghosts[];
};
// Where the lists begin, kind of bell by kind where there are several, and those of a kind block by block; where the last one
// ends; then the lists themselves, of multiples of LIST_STEP.
layout(std430, binding = BINDING_PARTIALS) readonly buffer Lists {
    uint lists[];
};
layout(std140, binding = BINDING_PASS) uniform Pass {
    ivec2 corner; // of the tile, in pixels of the picture
    ivec2 size;   // of the picture
    ivec2 first;  // pixel of the window
    int columns;  // of blocks
    int blocks;   // in all
    int shift;    // of a block's side, a power of two
    int width;    // of the tile
    double aspect; // a pixel's width over its height
    double length_unit; // of lengths, in half picture heights
};
#ifdef EXACT
layout(std430, binding = BINDING_NODES) buffer Canvas {
    uvec4 canvas_head;
    double canvas[]; // red, green, blue: pixel by pixel
};
#endif
layout(location = 0) out vec4 value;

// Adds the ghosts of one bell that a list has. A loop for each, as in `direct`.
#define SUM(kind, bell_of) \
    for (uint at = lists[kind * blocks + block], last = lists[kind * blocks + block + 1]; at < last; at += LIST_STEP) { \
        for (uint k = 0u; k < LIST_STEP; ++k) { \
            Ghost ghost = ghosts[lists[at + k]]; \
            precise dvec2 offset = dvec2(x, y) - ghost.center; \
            double bell = bell_of(offset, ghost.size, ghost.bell); \
            red += ghost.red * bell; \
            green += ghost.green * bell; \
            blue += ghost.blue * bell; \
        } \
    }

void main() {
    ivec2 p = corner + ivec2(gl_FragCoord.xy);
    ivec2 place = (p - first) >> shift;
    int block = place.y * columns + place.x;
    precise double tall = double(size.y) * length_unit;
    precise double x = aspect * double(2 * p.x + 1 - size.x) / tall;
    precise double y = double(size.y - 2 * p.y - 1) / tall;
    double red = 0.0lf, green = 0.0lf, blue = 0.0lf;
#ifdef EACH_BELL
    EACH_BELL(SUM)
#else
    SUM(0, bell_value)
#endif
#ifdef EXACT
    int at = 3 * (int(gl_FragCoord.y) * width + int(gl_FragCoord.x));
    canvas[at] = red;
    canvas[at + 1] = green;
    canvas[at + 2] = blue;
#endif
    value = vec4(red, green, blue, 0.0);
}

// `local`: what its ghosts have added up to in 64-bit floats.
layout(std430, binding = BINDING_NODES) readonly buffer Canvas {
    uvec4 canvas_head; // x: pixels in a row of the tile
    double canvas[];   // red, green, blue: pixel by pixel
};

dvec3 glare(ivec2 pixel) {
    int place = 3 * (pixel.y * int(canvas_head.x) + pixel.x);
    return dvec3(canvas[place], canvas[place + 1], canvas[place + 2]);
}

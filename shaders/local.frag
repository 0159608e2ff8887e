// A ghost of `local` at a pixel, to be added to what is there.
#include BELL

flat in vec2 base;
flat in vec4 steps; // from the centre to the pixel at `base`, and from pixel to pixel, in sizes
flat in vec3 weight;
flat in uint bell;
layout(location = 0) out vec4 value;

void main() {
    // Whole pixels, exactly: what the centre's place costs does not grow with the picture.
    vec2 offset = (gl_FragCoord.xy - base) * steps.zw + steps.xy;
    value = vec4(weight * bell_value(offset, vec2(1.0), bell), 0.0);
}

// `local`: what its ghosts have added up to on their canvas.
layout(binding = UNIT_CANVAS) uniform sampler2D canvas;

vec3 glare(ivec2 pixel) {
    return texelFetch(canvas, pixel, 0).rgb;
}

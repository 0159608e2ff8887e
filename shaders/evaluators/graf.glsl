// `graf`: the Fourier-Bessel series with the ghosts taken out by Graf's theorem (docs/math.md, "Fourier-Bessel and Graf").
//
// Unfolds the sums of one quadrant: mirroring x changes the sign of the odd cosines and of the even sines, mirroring y
// that of all sines.
layout(binding = UNIT_FOLDED) uniform sampler2D folded; // cosines of even and odd m, sines of even and odd m
layout(std140, binding = BINDING_EVALUATOR) uniform Graf {
    ivec2 corner; // of the tile, in pixels of the picture
    ivec2 size;   // of the picture, in pixels
    ivec2 first;  // pixel of the quadrant that `folded` begins with
    ivec2 pad0;
};

vec3 glare(ivec2 pixel) {
    ivec2 p = corner + pixel;
    ivec2 twice = ivec2(2 * p.x + 1 - size.x, size.y - 2 * p.y - 1);
    vec4 parts = texelFetch(folded, abs(twice) / 2 - first, 0);
    vec2 side = vec2(twice.x < 0 ? -1.0 : 1.0, twice.y < 0 ? -1.0 : 1.0);
    return vec3(parts.x + side.x * parts.y + side.x * side.y * parts.z + side.y * parts.w);
}

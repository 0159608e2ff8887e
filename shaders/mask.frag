// Which pixels of the photo are light, marked over what is there: the rest is left as it is. A pixel of the screen on
// which several of the photo fall is marked if one of them is light, so that a lone lamp is seen. A photo's rows count
// from the top and the screen's from the bottom.
layout(binding = UNIT_PHOTO) uniform sampler2D photo;
layout(std140, binding = BINDING_PASS) uniform Pass {
    vec3 weights;    // of linear R, G and B in luminance
    float threshold; // from which luminance on a pixel is light
    vec2 origin;     // of the screen's top left corner, in the photo's pixels
    float pitch;     // the photo's pixels from one of the screen to the next
    float rows;      // of the screen
    vec3 mark;       // the colour of a mark, as shown
    int most;        // rows and columns that are looked at
};
layout(location = 0) out vec4 shown;

// As the search for lights has it: not finite is no light, and below 0 counts as 0.
bool is_light(ivec2 at) {
    vec3 colour = texelFetch(photo, at, 0).rgb;
    if (any(isnan(colour)) || any(isinf(colour))) return false;
    colour = max(colour, 0.0);
    float luminance = weights.r * colour.r + weights.g * colour.g + weights.b * colour.b;
    return luminance >= threshold && luminance > 0.0;
}

void main() {
    vec2 at = origin + pitch * vec2(gl_FragCoord.x, rows - gl_FragCoord.y);
    ivec2 end = textureSize(photo, 0);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(end)))) discard;
    ivec2 first = ivec2(at), last = first;
    if (pitch > 1.0) {
        first = max(ivec2(floor(at - 0.5 * pitch)), 0);
        last = min(ivec2(ceil(at + 0.5 * pitch)), end) - 1;
    }
    ivec2 stride = (last - first + most) / most;
    for (int j = first.y; j <= last.y; j += stride.y) {
        for (int i = first.x; i <= last.x; i += stride.x) {
            if (is_light(ivec2(i, j))) {
                shown = vec4(mark, 1.0);
                return;
            }
        }
    }
    discard;
}

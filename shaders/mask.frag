// Which pixels of the photo are light, marked over what is there: the rest is left as it is. A pixel of the screen on
// which several of the photo fall is marked if one of them is light, so that a lone lamp is seen. A photo's rows count
// from the top and the screen's from the bottom.
#include "shared/emission.glsl"

layout(binding = UNIT_PHOTO) uniform sampler2D photo;
layout(std140, binding = BINDING_PASS) uniform Pass {
    vec3 weights;    // of linear R, G and B in luminance
    float threshold; // from which brightness on a pixel is light
    vec2 origin;     // of the screen's top left corner, in the photo's pixels
    float pitch;     // the photo's pixels from one of the screen to the next
    float rows;      // of the screen
    vec3 mark;       // the colour of a mark, as shown
    int most;        // rows and columns that are looked at
    float limit;     // how many times as bright as its neighbours a pixel may be; 0 for whatever it likes
};
layout(location = 0) out vec4 shown;

// As the search for lights has it: a single pixel that outshines all its neighbours is a firefly and no light.
bool is_marked(ivec2 at) {
    float brightness = emitted(texelFetch(photo, at, 0), weights);
    if (!is_light(brightness, threshold)) return false;
    ivec2 end = textureSize(photo, 0);
    if (limit == 0.0 || end == ivec2(1)) return true;
    ivec2 first = max(at - 1, 0), last = min(at + 1, end - 1);
    for (int j = first.y; j <= last.y; ++j) {
        for (int i = first.x; i <= last.x; ++i) {
            bool other = ivec2(i, j) != at;
            if (other && brightness <= limit * emitted(texelFetch(photo, ivec2(i, j), 0), weights)) return true;
        }
    }
    return false;
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
            if (is_marked(ivec2(i, j))) {
                shown = vec4(mark, 1.0);
                return;
            }
        }
    }
    discard;
}

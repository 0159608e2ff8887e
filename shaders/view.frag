// The photo or the picture as a display shows it, moved and magnified. A picture's rows count from the top and the
// screen's from the bottom: here, and nowhere else, one becomes the other.
#include "shared/tone.glsl"

layout(binding = UNIT_PHOTO) uniform sampler2D photo;
layout(binding = UNIT_PICTURE) uniform sampler2D picture;
layout(std140, binding = BINDING_PASS) uniform Pass {
    mat3 gamut;      // from the photo's primaries to Rec.709's
    vec2 origin;     // of the screen's top left corner, in the photo's pixels
    float pitch;     // the photo's pixels from one of the screen to the next
    float rows;      // of the screen
    vec3 surround;   // as shown
    float gain;      // of the light
    float wipe;      // columns of the screen from this one on show the picture, those before it the photo
    float pad0;
    float pad1;
    float pad2;
};
layout(location = 0) out vec4 shown;

// Fetches a side for one pixel of the screen. Farther out, rows and columns are left out.
const int MOST = 12;

vec3 texel(bool before, ivec2 at) {
    return before ? texelFetch(photo, at, 0).rgb : texelFetch(picture, at, 0).rgb;
}

// The mean of the light that falls on a pixel of the screen.
vec3 mean(bool before, vec2 center, ivec2 last) {
    vec2 low = max(center - 0.5 * pitch, vec2(0.0));
    vec2 high = min(center + 0.5 * pitch, vec2(last + 1));
    ivec2 first = ivec2(low);
    ivec2 count = min(ivec2(ceil(high)), last + 1) - first;
    ivec2 stride = (count + MOST - 1) / MOST;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int j = 0; j < count.y; j += stride.y) {
        float row = float(first.y + j);
        float tall = min(row + 1.0, high.y) - max(row, low.y);
        for (int i = 0; i < count.x; i += stride.x) {
            float column = float(first.x + i);
            float weight = tall * (min(column + 1.0, high.x) - max(column, low.x));
            sum += weight * texel(before, first + ivec2(i, j));
            weights += weight;
        }
    }
    return sum / weights;
}

void main() {
    vec2 pixel = vec2(gl_FragCoord.x, rows - gl_FragCoord.y);
    vec2 at = origin + pitch * pixel;
    ivec2 last = textureSize(photo, 0) - 1;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(last + 1)))) {
        shown = vec4(surround, 1.0);
        return;
    }
    bool before = pixel.x < wipe;
    vec3 light = pitch > 1.0 ? mean(before, at, last) : texel(before, ivec2(at));
#ifdef GAMUT
    light = gamut * light;
#endif
    shown = vec4(srgb_encoded(tone_mapped(gain * light)), 1.0);
}

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
    int stride;      // rows and columns from one that is looked at to the next, where it is made smaller
    int pad0;
    int pad1;
};
layout(location = 0) out vec4 shown;

vec3 texel(bool before, ivec2 at) {
#ifdef WIPE
    return before ? texelFetch(photo, at, 0).rgb : texelFetch(picture, at, 0).rgb;
#else
    return texelFetch(picture, at, 0).rgb;
#endif
}

#ifdef TAPS
// The mean of the light that falls on a pixel of the screen: TAPS rows and columns of the photo hold all of it.
vec3 mean(bool before, vec2 center, ivec2 last) {
    vec2 low = max(center - 0.5 * pitch, vec2(0.0));
    vec2 high = min(center + 0.5 * pitch, vec2(last + 1));
    ivec2 first = ivec2(low);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int j = 0; j < TAPS; j++) {
        for (int i = 0; i < TAPS; i++) {
            ivec2 at = min(first + stride * ivec2(i, j), last);
            vec2 from = vec2(first + stride * ivec2(i, j));
            vec2 side = max(min(from + 1.0, high) - max(from, low), 0.0);
            float weight = side.x * side.y;
            // What is not finite must not be weighted by 0.
            sum += weight > 0.0 ? weight * texel(before, at) : vec3(0.0);
            weights += weight;
        }
    }
    return sum / weights;
}
#endif

void main() {
    vec2 pixel = vec2(gl_FragCoord.x, rows - gl_FragCoord.y);
    vec2 at = origin + pitch * pixel;
    ivec2 last = textureSize(picture, 0) - 1;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(last + 1)))) {
        shown = vec4(surround, 1.0);
        return;
    }
    bool before = pixel.x < wipe;
#ifdef TAPS
    vec3 light = mean(before, at, last);
#else
    vec3 light = texel(before, ivec2(at));
#endif
#ifdef GAMUT
    light = gamut * light;
#endif
    shown = vec4(srgb_encoded(tone_mapped(gain * light)), 1.0);
}

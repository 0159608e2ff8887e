// The photo or the picture as a display shows it, moved and magnified. A picture's rows count from the top and the
// screen's from the bottom: here, and nowhere else, one becomes the other.
#include "shared/tone.glsl"

layout(binding = UNIT_PHOTO) uniform sampler2D photo;
#ifdef MIXED
#include "shared/normalized.glsl"
#include "shared/overlay.glsl"
layout(binding = UNIT_FIELD) uniform sampler2D field;
#else
layout(binding = UNIT_PICTURE) uniform sampler2D picture;
#endif
layout(std140, binding = BINDING_PASS) uniform Pass {
    mat3 gamut;      // from the photo's primaries to Rec.709's
    vec2 origin;     // of the screen's top left corner, in the photo's pixels
    float pitch;     // the photo's pixels from one of the screen to the next
    float rows;      // of the screen
    vec3 surround;   // as shown
    float gain;      // of the light
    vec3 scale;      // the field's unit, RGB
    float strength;  // of the glare
    vec3 constant;   // what is subtracted from the field, RGB
    float flat_span; // a range of the field no wider than this is rounding
    vec2 size;       // of the photo
    vec2 corner;     // of the means on the screen, where the photo is made smaller
    float wipe;      // columns of the screen from this one on show the picture, those before it the photo
    int means;       // not 0: the textures hold means, a texel a pixel of the screen
    vec2 coarse;     // texels of the field to a pixel of the photo, where it has fewer; else 0
    mat4x3 overlay_weights; // of each layer that is laid over the photo, RGB
};
layout(location = 0) out vec4 shown;

// The light at a place of the photo, or at the texel that holds it: before it got its glare, or after.
vec3 light_at(bool before, vec2 at, ivec2 texel) {
#if defined(BEFORE)
    vec3 light = texelFetch(photo, texel, 0).rgb;
#elif defined(MIXED)
    ivec2 place = coarse.x > 0.0 ? ivec2(coarse * at) : texel;
    vec3 light = strength * normalized(scale * texelFetch(field, place, 0).rgb - constant, flat_span);
#ifdef OVERLAY_LAYERS
    light += overlaid(texel, overlay_weights);
#endif
#ifndef GLARE_ALONE
    light += texelFetch(photo, texel, 0).rgb;
#endif
#else
    vec3 light = texelFetch(picture, texel, 0).rgb;
#endif
#ifdef WIPE
    light = before ? texelFetch(photo, texel, 0).rgb : light;
#endif
    return light;
}

void main() {
    vec2 pixel = vec2(gl_FragCoord.x, rows - gl_FragCoord.y);
    vec2 at = origin + pitch * pixel;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, size))) {
        shown = vec4(surround, 1.0);
        return;
    }
    vec3 light = light_at(pixel.x < wipe, at, ivec2(means != 0 ? pixel - corner : at));
#ifdef GAMUT
    light = gamut * light;
#endif
    shown = vec4(srgb_encoded(tone_mapped(gain * light)), 1.0);
}

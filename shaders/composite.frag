// The photo with its glare. Alpha is left as it is.
#include EVALUATOR
#include "shared/emission.glsl"
#include "shared/normalized.glsl"
#include "shared/overlay.glsl"

layout(binding = UNIT_PHOTO) uniform sampler2D photo;
layout(std140, binding = BINDING_PASS) uniform Pass {
    vec4 scale;      // the field's unit, RGB
    vec4 constant;   // what is subtracted from the field, RGB
    vec4 light_gain; // what a light keeps of itself, RGB; 1 unless light is taken from the photo
    vec4 luminance;  // weights of R, G, B; w: the brightness from which on a pixel is a light
    float strength;
    float flat_span; // a range no wider than this is rounding
    vec2 knee;       // a soft threshold, and how far below and above it the transition goes
    mat4x3 overlay_weights; // of each layer that is laid over the photo, RGB
};
layout(location = 0) out vec4 picture;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 added = strength * normalized(scale.rgb * vec3(glare(pixel)) - constant.rgb, flat_span);
#ifdef OVERLAY_LAYERS
    added += overlaid(pixel, overlay_weights);
#endif
#ifdef GLARE_ALONE
    picture = vec4(added, 1.0);
#else
    vec4 light = texelFetch(photo, pixel, 0);
#ifdef TAKE_LIGHT
#ifdef SOFT
    bool gives = true;
    vec3 keeps = 1.0 - shining(light, knee) * (1.0 - light_gain.rgb);
#else
    bool gives = is_light(emitted(light, luminance.rgb), luminance.w);
    vec3 keeps = light_gain.rgb;
#endif
    // Of a light, what is below 0 is no light.
    light.rgb *= gives ? mix(vec3(1.0), keeps, greaterThan(light.rgb, vec3(0.0))) : vec3(1.0);
#endif
    picture = vec4(light.rgb + added, light.a);
#endif
}

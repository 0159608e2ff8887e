// Graf's sum over k at a list of radii: texel (m, radius) is what cos(m theta) and sin(m theta) are multiplied by there,
// and the slopes of these two from radius to radius.
#include "shared/bessel.glsl"

layout(std430, binding = BINDING_SPECTRUM) readonly buffer Spectrum {
    vec2 terms[]; // (U, V), m running fastest
};
layout(std140, binding = BINDING_PASS) uniform Pass {
    int zeros;  // N
    int orders; // M + 1
    int pad0;
    int pad1;
};
layout(location = 0) out vec4 radial;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < zeros; ++k) {
        vec4 place = texelFetch(places, ivec2(k, texel.y), 0); // z: cells from radius to radius
        vec2 j = bessel_j(texel.x, place);
        sum += terms[k * orders + texel.x].xyxy * vec2(j.x, place.z * j.y).xxyy;
    }
    radial = sum;
}

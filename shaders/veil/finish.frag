// The veil at the pixels: what lattices and separable kernels summed, the small kernel, and moments of the whole photo, less what
// all of them give a pixel of its own light.
layout(binding = UNIT_PHOTO) uniform sampler2D sources;
#ifdef ADDED
layout(binding = UNIT_PICTURE) uniform sampler2D before;
#endif
layout(std140, binding = BINDING_PASS) uniform Pass {
    ivec2 first;    // texel of the sources that is the target's first
    ivec2 size;     // of the sources
    vec2 middle;    // of the sources: where moments are counted from
    int rows;       // of the small kernel, from offset 0 on
    int pad;
    vec4 constant;  // moments, RGB: a constant,
    vec4 across;    // what is times the place from the middle,
    vec4 down;
    vec4 square;    // and what is times its square
    ivec4 fours[VEIL_NEAR_ROWS]; // taps of each row of the small kernel, in fours: four rows in each
};
// A pixel's own light in a period of columns and rows, four in each; then the small kernel's taps, row by row. A tap with
// a distance of no columns or no rows is halved for each, as it is met twice then.
layout(std140, binding = BINDING_TAPS) uniform Taps {
    vec4 taps[VEIL_TAPS];
};
layout(location = 0) out vec4 veil;

vec3 light(ivec2 at) {
    bool there = at.x >= 0 && at.y >= 0 && at.x < size.x && at.y < size.y;
    return there ? texelFetch(sources, at, 0).rgb : vec3(0.0);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 at = first + texel;
    vec3 near = vec3(0.0);
    int tap = VEIL_PERIOD * VEIL_PERIOD / 4;
    for (int y = 0; y < rows; ++y) {
        for (int four = 0, count = fours[y >> 2][y & 3]; four < count; ++four, ++tap) {
            for (int k = 0; k < 4; ++k) {
                int x = 4 * four + k;
                vec3 above = light(at + ivec2(-x, -y)) + light(at + ivec2(x, -y));
                vec3 below = light(at + ivec2(-x, y)) + light(at + ivec2(x, y));
                near += taps[tap][k] * (above + below);
            }
        }
    }
    vec2 place = vec2(at) - middle;
    vec3 moments = constant.rgb + (across.rgb * place.x + down.rgb * place.y) + square.rgb * dot(place, place);
    ivec2 phase = at & (VEIL_PERIOD - 1);
    float own = taps[(VEIL_PERIOD * phase.y + phase.x) >> 2][phase.x & 3];
    vec3 total = moments + near;
#ifdef ADDED
    total += texelFetch(before, texel, 0).rgb;
#endif
    veil = vec4(max(total - own * light(at), 0.0), 0.0);
}

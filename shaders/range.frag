// One step of the reduction to minimum and maximum; texels are (min, -max), so that both are minima.
//
// A level is half the one before it, rounded down, so a texel stands for two or three of its source's along each axis:
// the last column and row of an odd side count as well.
layout(std140, binding = BINDING_PASS) uniform Pass {
    vec4 scale; // the field's unit, RGB
    ivec2 size; // of the source; textureSize is slow on Mesa's software renderer
    ivec2 pad;
};
#ifdef FROM_FIELD
layout(binding = UNIT_FIELD) uniform sampler2D source;

vec2 texel_range(ivec2 texel) {
    vec3 value = scale.rgb * texelFetch(source, texel, 0).rgb;
    return vec2(min(value.r, min(value.g, value.b)), -max(value.r, max(value.g, value.b)));
}
#else
layout(binding = UNIT_RANGE) uniform sampler2D source;

vec2 texel_range(ivec2 texel) {
    return texelFetch(source, texel, 0).xy;
}
#endif
layout(location = 0) out vec2 ends;

void main() {
    ivec2 target = max(size / 2, ivec2(1));
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 first = texel * size / target;
    ivec2 last = ((texel + 1) * size + target - 1) / target;
    vec2 result = texel_range(first);
    for (int y = first.y; y < last.y; ++y) {
        for (int x = first.x; x < last.x; ++x) {
            result = min(result, texel_range(ivec2(x, y)));
        }
    }
    ends = result;
}

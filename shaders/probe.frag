// The field at a list of pixels, by the very function that makes the picture.
#include EVALUATOR

layout(std430, binding = BINDING_PROBES) readonly buffer Probes {
    ivec2 probes[];
};
layout(location = 0) out vec4 value;

void main() {
    value = vec4(vec3(glare(probes[int(gl_FragCoord.x)])), 1.0);
}

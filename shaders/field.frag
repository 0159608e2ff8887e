// The field at every pixel of the target, in units of its scale.
#include EVALUATOR

layout(location = 0) out vec4 value;

void main() {
    value = vec4(vec3(glare(ivec2(gl_FragCoord.xy))), 1.0);
}

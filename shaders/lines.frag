// A line in one colour.
layout(std140, binding = BINDING_PASS) uniform Pass {
    vec4 window;
    vec4 colour;
};
layout(location = 0) out vec4 picture;

void main() {
    picture = colour;
}

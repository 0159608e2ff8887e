// A vertex of a line in the numbers of its plot. The picture's top row is row 0, so up is towards -1.
layout(location = 0) in vec2 vertex;
layout(std140, binding = BINDING_PASS) uniform Pass {
    vec4 window; // what lies at the left and the bottom, and the plot's width and height
    vec4 colour;
};

void main() {
    vec2 place = 2.0 * (vertex - window.xy) / window.zw - 1.0;
    gl_Position = vec4(place.x, -place.y, 0.0, 1.0);
}

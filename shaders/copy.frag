// A copy and nothing else: what the passes are measured against.
layout(binding = UNIT_PHOTO) uniform sampler2D photo;
layout(location = 0) out vec4 picture;

void main() {
    picture = texelFetch(photo, ivec2(gl_FragCoord.xy), 0);
}

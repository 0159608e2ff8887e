// Graf's sum over m at the pixels of one quadrant of the picture, in four parts:
//
//     G(r, theta) = sum over m of  C_m(r) cos(m theta) + S_m(r) sin(m theta)      even m, odd m; C, S
//
// C_m and S_m stand in a table over r, with their slopes; between two radii they are Hermite's cubics.
layout(binding = UNIT_RADIAL) uniform sampler2D radial; // (m, radius): (C, S, slope of C, slope of S)
layout(std140, binding = BINDING_PASS) uniform Pass {
    ivec2 first; // pixel of the quadrant that the target begins with
    ivec2 even;  // 1 where the picture's side is even: its middle lies between two pixels
    float rate;  // radii a unit of length
    int orders;  // M + 1
    int last;    // radius that another one follows
    int pad;
    vec2 unit;   // half a pixel's width and height
};
layout(location = 0) out vec4 folded;

vec2 multiply(vec2 a, vec2 b) {
    return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

void main() {
    vec2 position = vec2(2 * (first + ivec2(gl_FragCoord.xy)) + even) * unit;
    float r = length(position);
    vec2 z = r > 0.0 ? position / r : vec2(1.0, 0.0); // exp(i theta)
    vec2 zz = multiply(z, z);
    int row = min(int(r * rate), last);
    float t = r * rate - float(row);
    float u = 1.0 - t;
    vec4 weights = vec4((1.0 + 2.0 * t) * u * u, t * u * u, t * t * (3.0 - 2.0 * t), -t * t * u);
    // Horner's scheme in z^2 for four sums of real numbers times z^m. An error of z itself only moves the point.
    vec2 cosine_even = vec2(0.0), cosine_odd = vec2(0.0), sine_even = vec2(0.0), sine_odd = vec2(0.0);
    for (int m = orders - 1; m >= 0; --m) {
        vec4 a = texelFetch(radial, ivec2(m, row), 0);
        vec4 b = texelFetch(radial, ivec2(m, row + 1), 0);
        vec2 here = weights.x * a.xy + weights.y * a.zw + weights.z * b.xy + weights.w * b.zw;
        // Even and odd take turns: what was even is the odd one's next time.
        vec2 cosine = multiply(cosine_odd, zz), sine = multiply(sine_odd, zz);
        cosine_odd = cosine_even;
        sine_odd = sine_even;
        cosine_even = vec2(cosine.x + here.x, cosine.y);
        sine_even = vec2(sine.x + here.y, sine.y);
    }
    folded = vec4(cosine_even.x, multiply(cosine_odd, z).x, sine_even.y, multiply(sine_odd, z).y);
}

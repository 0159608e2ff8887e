// What bells need to know beside offset and size, several rows a bell.
layout(std430, binding = BINDING_SHAPES) readonly buffer Shapes {
#ifdef DOUBLE
    dvec4 shapes[];
#else
    vec4 shapes[];
#endif
};

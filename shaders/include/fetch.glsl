// Reads the scene row by row (16 bytes) through one kind of memory, chosen when the shader is
// compiled: storage texel buffers (FETCH_TEXEL; 20 times faster than a storage buffer on
// lavapipe, whose storage buffer loads are a scalar loop over the lanes) or storage buffers.
// Rows are integers: floats pass through uintBitsToFloat, so that no bit pattern is altered.

#ifdef FETCH_TEXEL
#define SCENE_BUFFER(binding_, name)                                                               \
    layout(set = 0, binding = binding_, rgba32ui) uniform readonly uimageBuffer name;
#define ROW(name, i) imageLoad(name, int(i))
#else
#define SCENE_BUFFER(binding_, name)                                                               \
    layout(set = 0, binding = binding_, std430) readonly buffer name##Buffer { uvec4 rows[]; }     \
    name;
#define ROW(name, i) name.rows[i]
#endif

SCENE_BUFFER(BINDING_NODES, nodeRows)
SCENE_BUFFER(BINDING_PRIMITIVES, primitiveRows)
SCENE_BUFFER(BINDING_NORMALS, normalRows)
SCENE_BUFFER(BINDING_MATERIALS, materialRows)
SCENE_BUFFER(BINDING_LIGHTS, lightRows)
SCENE_BUFFER(BINDING_EMITTER_ENTRIES, emitterEntryRows)

Node fetchNode(uint index) {
    const uvec4 r0 = ROW(nodeRows, 4u * index), r1 = ROW(nodeRows, 4u * index + 1u);
    const uvec4 r2 = ROW(nodeRows, 4u * index + 2u), r3 = ROW(nodeRows, 4u * index + 3u);
    return Node(uintBitsToFloat(r0.xyz), r0.w, uintBitsToFloat(r1.xyz), r1.w,
                uintBitsToFloat(r2.xyz), r2.w, uintBitsToFloat(r3.xyz), r3.w);
}

Primitive fetchPrimitive(uint index) {
    const uvec4 r0 = ROW(primitiveRows, 3u * index), r1 = ROW(primitiveRows, 3u * index + 1u);
    const uvec4 r2 = ROW(primitiveRows, 3u * index + 2u);
    return Primitive(uintBitsToFloat(r0.xyz), r0.w, uintBitsToFloat(r1.xyz), r1.w,
                     uintBitsToFloat(r2.xyz), r2.w);
}

NormalTriple fetchNormals(uint index) {
    const uvec4 r = ROW(normalRows, index);
    return NormalTriple(r.x, r.y, r.z, r.w);
}

Material fetchMaterial(uint index) {
    const uvec4 r0 = ROW(materialRows, 4u * index);
    uvec4 r1 = uvec4(0u), r2 = uvec4(0u), r3 = uvec4(0u);
    if (HAS_EMISSION) r1 = ROW(materialRows, 4u * index + 1u);
    if (sceneHasMaterial(MATERIAL_REFRACTION) || sceneHasMaterial(MATERIAL_GLASS) ||
        sceneHasMaterial(MATERIAL_MICROFACET))
        r2 = ROW(materialRows, 4u * index + 2u);
    if (sceneHasMaterial(MATERIAL_MICROFACET)) r3 = ROW(materialRows, 4u * index + 3u);
    return Material(uintBitsToFloat(r0.xyz), r0.w, uintBitsToFloat(r1.xyz), r1.w,
                    uintBitsToFloat(r2.xyz), uintBitsToFloat(r2.w), uintBitsToFloat(r3.xyz), r3.w);
}

Light fetchLight(uint index) {
    const uvec4 r0 = ROW(lightRows, 5u * index), r1 = ROW(lightRows, 5u * index + 1u);
    const uvec4 r2 = ROW(lightRows, 5u * index + 2u), r3 = ROW(lightRows, 5u * index + 3u);
    uvec4 r4 = uvec4(0u);
    if (sceneHasLight(LIGHT_MESH) || sceneHasLight(LIGHT_SPOT))
        r4 = ROW(lightRows, 5u * index + 4u);
    return Light(uintBitsToFloat(r0.xyz), r0.w, uintBitsToFloat(r1.xyz), uintBitsToFloat(r1.w),
                 uintBitsToFloat(r2.xyz), r2.w, uintBitsToFloat(r3.xyz), r3.w, r4.x, r4.y,
                 uintBitsToFloat(r4.z), uintBitsToFloat(r4.w));
}

EmitterEntry fetchEmitterEntry(uint index) {
    const uvec4 r = ROW(emitterEntryRows, index);
    return EmitterEntry(r.x, r.y, uintBitsToFloat(r.z), r.w);
}

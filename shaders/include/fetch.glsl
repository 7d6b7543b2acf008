// Reads the scene row by row (16 bytes) through one kind of memory, chosen when the shader is
// compiled: storage texel buffers (FETCH_TEXEL; 20 times faster than a storage buffer on
// lavapipe, whose storage buffer loads are a scalar loop over the lanes) or storage buffers.
// Rows are integers: floats pass through uintBitsToFloat, so that no bit pattern is altered.

#ifdef FETCH_TEXEL
#define SCENE_BUFFER(binding_, name)                                                               \
    layout(set = 0, binding = binding_, rgba32ui) uniform readonly uimageBuffer name;
#define ROW(name, i) imageLoad(name, int((i) & TEXEL_ROW_MASK))
#else
#define SCENE_BUFFER(binding_, name)                                                               \
    layout(set = 0, binding = binding_, std430) readonly buffer name##Buffer { uvec4 rows[]; }     \
    name;
#define ROW(name, i) name.rows[i]
#endif

SCENE_BUFFER(BINDING_RECORDS, recordRows)
SCENE_BUFFER(BINDING_PRIMITIVES, primitiveRows)
SCENE_BUFFER(BINDING_MATERIALS, materialRows)
SCENE_BUFFER(BINDING_LIGHTS, lightRows)
SCENE_BUFFER(BINDING_EMITTER_ENTRIES, emitterEntryRows)

/// A record of the BVH as it lies in memory: a NodeRecord or a LeafRecord.
struct Record {
    uvec4 r0, r1, r2, r3;
};

Record fetchRecord(uint index) {
    const uint row = RECORD_ROWS * index;
    return Record(ROW(recordRows, row), ROW(recordRows, row + 1u), ROW(recordRows, row + 2u),
                  ROW(recordRows, row + 3u));
}

/// The points of a leaf: slot 0 is the triangle p0 p1 p2, slot 1 is p0 p2 p3.
struct LeafPoints {
    vec3 p0, p1, p2, p3;
};

LeafPoints leafPoints(Record r) {
    return LeafPoints(uintBitsToFloat(r.r0.xyz), uintBitsToFloat(r.r1.xyz),
                      uintBitsToFloat(r.r3.xyz), uintBitsToFloat(r.r2.xyz));
}

float leafRadius(Record r) { return uintBitsToFloat(r.r3.w); }

/// One primitive by its place in the tree, 2 * record + slot.
struct PlacedPrimitive {
    vec3 v0, v1, v2; ///< corners; spheres: v0 is the centre
    float radius;    ///< spheres
    bool isSphere;
    uint primitive; ///< in the Primitive buffer
};

PlacedPrimitive fetchPlace(uint place) {
    const uint slot = place & 1u, row = RECORD_ROWS * (place >> 1u);
    const uvec4 first = ROW(recordRows, row), last = ROW(recordRows, row + 3u);
    const vec3 own = uintBitsToFloat(ROW(recordRows, row + 1u + slot).xyz); // p1 or p3
    const vec3 p2 = uintBitsToFloat(last.xyz);
    PlacedPrimitive p;
    p.v0 = uintBitsToFloat(first.xyz);
    p.v1 = slot == 0u ? own : p2;
    p.v2 = slot == 0u ? p2 : own;
    p.radius = uintBitsToFloat(last.w);
    p.isSphere = HAS_SPHERES && (!HAS_TRIANGLES || (first.w & RECORD_IS_SPHERE) != 0u);
    p.primitive = (first.w & RECORD_INDEX_MASK) + slot;
    return p;
}

Primitive fetchPrimitive(uint index) {
    const uvec4 r = ROW(primitiveRows, index);
    return Primitive(r.x, r.y, r.z, r.w);
}

bool isSmooth(Primitive p) { return HAS_NORMALS && (p.material & PRIMITIVE_IS_SMOOTH) != 0u; }

uint materialOf(Primitive p) { return HAS_NORMALS ? p.material & ~PRIMITIVE_IS_SMOOTH : p.material; }

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

/// root: row of the tree's first node.
LightNode fetchLightNode(uint root, uint index) {
    const uvec4 r0 = ROW(emitterEntryRows, root + 2u * index),
                r1 = ROW(emitterEntryRows, root + 2u * index + 1u);
    return LightNode(uintBitsToFloat(r0.xyz), uintBitsToFloat(r0.w), r1.x, uintBitsToFloat(r1.y),
                     uintBitsToFloat(r1.z), r1.w);
}

EmitterEntry fetchEmitterEntry(uint index) {
    const uvec4 r = ROW(emitterEntryRows, index);
    return EmitterEntry(r.x, r.y, uintBitsToFloat(r.z), r.w);
}

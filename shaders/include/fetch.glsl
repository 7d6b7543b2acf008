// Reads the scene row by row (16 bytes) through one kind of memory, chosen when the shader is
// compiled: storage texel buffers (FETCH_TEXEL) or storage buffers (docs/theory/kernel.md, "Fetch").
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
SCENE_BUFFER(BINDING_LIGHT_TABLE, lightTableRows)
SCENE_BUFFER(BINDING_ENVIRONMENT, environmentRows)
SCENE_BUFFER(BINDING_DETAIL, detailRows)
SCENE_BUFFER(BINDING_FILTER, filterRows)

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

float leafRadius(Record r) { return uintBitsToFloat(r.r3.w); } ///< of a sphere
uint leafHome(Record r) { return r.r3.w; }                     ///< of triangles

/// One primitive by its place in the tree, 2 * record + slot.
struct PlacedPrimitive {
    vec3 v0, v1, v2; ///< corners; spheres: v0 is the centre
    float radius;    ///< spheres
    bool isSphere;
    uint primitive; ///< in the Primitive buffer
    uint light;     ///< its number among the lights; NO_LIGHT: it is none
};

PlacedPrimitive fetchPlace(uint place) {
    const uint slot = place & 1u, row = RECORD_ROWS * (place >> 1u);
    const uvec4 first = ROW(recordRows, row), last = ROW(recordRows, row + 3u);
    const uvec4 ownRow = ROW(recordRows, row + 1u + slot);
    const vec3 own = uintBitsToFloat(ownRow.xyz); // p1 or p3
    const vec3 p2 = uintBitsToFloat(last.xyz);
    PlacedPrimitive p;
    p.v0 = uintBitsToFloat(first.xyz);
    p.v1 = slot == 0u ? own : p2;
    p.v2 = slot == 0u ? p2 : own;
    p.radius = uintBitsToFloat(last.w);
    p.isSphere = HAS_SPHERES && (!HAS_TRIANGLES || (first.w & RECORD_IS_SPHERE) != 0u);
    p.primitive = (first.w & RECORD_INDEX_MASK) + slot;
    p.light = ownRow.w;
    return p;
}

Primitive fetchPrimitive(uint index) {
    const uvec4 r = ROW(primitiveRows, index);
    return Primitive(r.x, r.y, r.z, r.w);
}

bool isSmooth(Primitive p) { return HAS_CORNER_NORMALS && (p.material & PRIMITIVE_IS_SMOOTH) != 0u; }

uint materialOf(Primitive p) { return HAS_CORNER_NORMALS ? p.material & ~PRIMITIVE_IS_SMOOTH : p.material; }

// --- Materials (shaders/shared/bsdf_types.h) --------------------------------------------------

/// The rows of a material: its header, and those that its closures read their parameters from.
struct Material {
    uvec4 header, row1, row2;
    uvec4 row3, row4, row5, row6; ///< of those that have as many
};

bool hasClosure(Material m, uint bit) { return has(m.header.w, bit); }

const bool HAS_RECIPES = (CLOSURES & (RECIPE_PRINCIPLED | RECIPE_BURLEY)) != 0u;

/// Whether some material of the scene has this row behind its header.
bool materialsHaveRow(uint row) {
    const bool hasIndices = sceneHas(INTERFACE_IS_CONDUCTOR | CLOSURE_LAYERS | GLOSSY_LOBES);
    if (row <= 1u) return true;
    if (row == 2u) return hasIndices || sceneHas(INTERFACE_IS_DIELECTRIC);
    if (row == 3u) return hasIndices;
    return row <= 5u ? HAS_RECIPES : sceneHas(RECIPE_PRINCIPLED);
}

/// row: the material's first. Rows that no material of the scene has are not read.
Material fetchMaterial(uint row) {
    const uvec4 none = uvec4(0u);
    Material m = Material(none, none, none, none, none, none, none);
    const bool differ = (CLOSURES & ~CLOSURES_OF_ALL) != 0u;
    if (HAS_EMISSION || differ || BLACK_BACKS || RELIEF_RULES)
        m.header = ROW(materialRows, row);
    m.row1 = ROW(materialRows, row + 1u);
    if (materialsHaveRow(2u)) m.row2 = ROW(materialRows, row + 2u);
    if (materialsHaveRow(3u)) m.row3 = ROW(materialRows, row + 3u);
    if (materialsHaveRow(4u)) m.row4 = ROW(materialRows, row + 4u);
    if (materialsHaveRow(5u)) m.row5 = ROW(materialRows, row + 5u);
    if (materialsHaveRow(6u)) m.row6 = ROW(materialRows, row + 6u);
    return m;
}

vec3 emissionOf(Material m) { return uintBitsToFloat(m.header.xyz); }
bool isBlackBehind(Material m) { return BLACK_BACKS && (m.header.w & MATERIAL_IS_BLACK_BEHIND) != 0u; }
/// MATERIAL_RELIEF_ bits.
uint reliefRules(Material m) { return RELIEF_RULES ? m.header.w & MATERIAL_RELIEF_RULES : 0u; }
bool emitsBothSides(Material m) { return (m.header.w & MATERIAL_EMITS_BOTH_SIDES) != 0u; }

// The parameters, of a material that has these.

StatedParameters statedParameters(Material m) {
    StatedParameters p = StatedParameters(uintBitsToFloat(m.row1.xyz), uintBitsToFloat(m.row1.w), uintBitsToFloat(m.row2.xyz),
                                          uintBitsToFloat(m.row2.w), uintBitsToFloat(m.row3.xyz), m.row3.w);
    if (!materialsHaveRow(3u)) p.index[INDEX_RATIO] = p.alphaY;
    return p;
}

PrincipledParameters principledParameters(Material m) {
    const vec4 row1 = uintBitsToFloat(m.row1), row2 = uintBitsToFloat(m.row2);
    const vec4 row3 = uintBitsToFloat(m.row3), row4 = uintBitsToFloat(m.row4);
    const vec4 row5 = uintBitsToFloat(m.row5), row6 = uintBitsToFloat(m.row6);
    return PrincipledParameters(row1.xyz, row1.w, row2.xyz, row2.w, row3.x, row3.y, row3.z, row3.w,
                                row4.xyz, row4.w, row5.x, row5.y, row5.z, m.row5.w, row6.xyz, row6.w);
}

BurleyParameters burleyParameters(Material m) {
    const vec4 row1 = uintBitsToFloat(m.row1), row2 = uintBitsToFloat(m.row2);
    const vec4 row3 = uintBitsToFloat(m.row3), row4 = uintBitsToFloat(m.row4);
    const vec4 row5 = uintBitsToFloat(m.row5);
    return BurleyParameters(row1.xyz, row1.w, row2.x, row2.y, row2.z, row2.w, row3.x, row3.y, row3.z, row3.w,
                            row4.xyz, row4.w, row5.x, row5.y, row5.z, m.row5.w);
}

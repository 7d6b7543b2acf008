// Reads the scene row by row (16 bytes) through one kind of memory, chosen when the shader is
// compiled: storage texel buffers (FETCH_TEXEL) or storage buffers (docs/theory/kernel.md, "Fetch").
// Rows are integers: floats pass through uintBitsToFloat, so that no bit pattern is altered.

#include "shared/medium_types.h"

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
SCENE_BUFFER(BINDING_GUIDE, guideRows)

uint componentOf(uvec4 row, uint index) {
    const uvec2 pair = index < 2u ? row.xy : row.zw;
    return (index & 1u) == 0u ? pair.x : pair.y;
}

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
    uvec4 row3, row4, row5, row6, row7, row8; ///< of those that have as many
};

bool hasClosure(Material m, uint bit) { return has(m.header.w, bit); }

/// Whether some material of the scene has this row behind its header.
bool materialsHaveRow(uint row) {
    return row <= 1u || sceneHas(closuresWithRow(row)) || row == MEDIUM_PHASES_ROW && (MEDIA & MEDIA_MIX) != 0u;
}

/// row: the material's first. Rows that no material of the scene has are not read.
Material fetchMaterial(uint row) {
    const uvec4 none = uvec4(0u);
    Material m = Material(none, none, none, none, none, none, none, none, none);
    const bool differ = (CLOSURES & ~CLOSURES_OF_ALL) != 0u;
    if (HAS_EMISSION || differ || BLACK_BACKS || RELIEF_RULES)
        m.header = ROW(materialRows, row);
    m.row1 = ROW(materialRows, row + 1u);
    if (materialsHaveRow(2u)) m.row2 = ROW(materialRows, row + 2u);
    if (materialsHaveRow(3u)) m.row3 = ROW(materialRows, row + 3u);
    if (materialsHaveRow(4u)) m.row4 = ROW(materialRows, row + 4u);
    if (materialsHaveRow(5u)) m.row5 = ROW(materialRows, row + 5u);
    if (materialsHaveRow(6u)) m.row6 = ROW(materialRows, row + 6u);
    if (sceneHas(LOBE_DIFFUSE_TRANSMISSION)) m.row7 = ROW(materialRows, row + 7u);
    if (HAS_IRIDESCENCE) m.row8 = ROW(materialRows, row + 8u);
    return m;
}

vec3 emissionOf(Material m) { return uintBitsToFloat(m.header.xyz); }
bool isBlackBehind(Material m) { return BLACK_BACKS && (m.header.w & MATERIAL_IS_BLACK_BEHIND) != 0u; }
/// MATERIAL_RELIEF_ bits.
uint reliefRules(Material m) { return RELIEF_RULES ? m.header.w & MATERIAL_RELIEF_RULES : 0u; }
bool emitsBothSides(Material m) { return (m.header.w & MATERIAL_EMITS_BOTH_SIDES) != 0u; }

// By which recipe a material's closures follow from its parameters.

bool isOfPrincipled(Material m) { return hasClosure(m, RECIPE_PRINCIPLED); }
bool isOfBurley(Material m) { return hasClosure(m, RECIPE_BURLEY); }
bool isOfStated(Material m) { return !isOfPrincipled(m) && !isOfBurley(m); }

// The parameters (shared/parameters.h), of a material of the recipe, and functions that multiply or raise one of them.

vec3 as_vec3(uvec3 bits) { return uintBitsToFloat(bits); }
float as_float(uint bits) { return uintBitsToFloat(bits); }
uint as_uint(uint bits) { return bits; }
void multiply(inout uvec3 bits, vec3 factor) { bits = floatBitsToUint(uintBitsToFloat(bits) * factor); }
void multiply(inout uint bits, float factor) { bits = floatBitsToUint(uintBitsToFloat(bits) * factor); }

#define READ_PARAMETER(type, name, at, place, value) p.name = as_##type(m.row##at.place);
StatedParameters statedParameters(Material m) {
    StatedParameters p;
    STATED_PARAMETERS(READ_PARAMETER)
    if (!materialsHaveRow(3u)) p.index[INDEX_RATIO] = p.alphaY;
    return p;
}
PrincipledParameters principledParameters(Material m) {
    PrincipledParameters p;
    PRINCIPLED_PARAMETERS(READ_PARAMETER)
    return p;
}
BurleyParameters burleyParameters(Material m) {
    BurleyParameters p;
    BURLEY_PARAMETERS(READ_PARAMETER)
    return p;
}
#undef READ_PARAMETER

#define FACTOR_vec3 vec3
#define FACTOR_float float
#define FACTOR_uint float
#define MULTIPLY_PARAMETER(recipe, type, name, at, place) \
    void multiply##recipe##_##name(inout Material m, FACTOR_##type factor) { multiply(m.row##at.place, factor); }
#define MULTIPLY_STATED(type, name, at, place, value) MULTIPLY_PARAMETER(Stated, type, name, at, place)
#define MULTIPLY_PRINCIPLED(type, name, at, place, value) MULTIPLY_PARAMETER(Principled, type, name, at, place)
#define MULTIPLY_BURLEY(type, name, at, place, value) MULTIPLY_PARAMETER(Burley, type, name, at, place)
STATED_PARAMETERS(MULTIPLY_STATED)
PRINCIPLED_PARAMETERS(MULTIPLY_PRINCIPLED)
BURLEY_PARAMETERS(MULTIPLY_BURLEY)
#undef MULTIPLY_STATED
#undef MULTIPLY_PRINCIPLED
#undef MULTIPLY_BURLEY

#define WRITE_PARAMETER(type, name, at, place, value) m.row##at.place = bits_##type(p.name);
uvec3 bits_vec3(vec3 v) { return floatBitsToUint(v); }
uint bits_float(float x) { return floatBitsToUint(x); }
uint bits_uint(uint x) { return x; }
void setParameters(inout Material m, PrincipledParameters p) { PRINCIPLED_PARAMETERS(WRITE_PARAMETER) }
#undef WRITE_PARAMETER

/// What base colours multiply is in the first place by every recipe.
void multiplyBaseColor(inout Material m, vec3 factor) {
    if (hasClosure(m, HAS_BASE_COLOR)) multiply(m.row1.xyz, factor);
}

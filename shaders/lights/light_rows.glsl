// Reads lights and the table that one of them is picked by (shaders/shared/light_types.h).

/// Whether some light of the scene that is sampled has so many rows of parameters.
bool lightsHaveRows(uint wanted) {
#define HAS_ROWS(name, number, rows, label) || uint(rows) >= wanted && samplesLightKind(LIGHT_##name)
    return false LIGHT_LIST(HAS_ROWS);
#undef HAS_ROWS
}

/// Rows that no kind of the scene has are not read.
LightRows fetchLightRows(uint light) {
    const uint row = LIGHT_ROWS * light;
    LightRows l = LightRows(ROW(lightRows, row), uvec4(0u), uvec4(0u), uvec4(0u));
    l.row1 = ROW(lightRows, row + 1u);
    if (lightsHaveRows(2u) || HAS_ENVIRONMENT) l.row2 = ROW(lightRows, row + 2u);
    if (lightsHaveRows(3u)) l.row3 = ROW(lightRows, row + 3u);
    return l;
}

vec3 colorOf(LightRows l) { return uintBitsToFloat(l.header.xyz); }
uint kindOf(LightRows l) { return l.header.w & LIGHT_KIND_MASK; }
bool hasFlag(LightRows l, uint flag) { return (l.header.w & flag) != 0u; }

#define READ_FIELD(type, name, at, place) p.name = as_##type(l.row##at.place);
#define READ_LIGHT(structure, function, fields, met, sample) \
    structure function(LightRows l) { \
        structure p; \
        fields(READ_FIELD) \
        return p; \
    }
LIGHT_STRUCTURES(READ_LIGHT)
#undef READ_LIGHT
#undef READ_FIELD

bool isTriangleLight(uint light) {
    return samplesLightKind(LIGHT_TRIANGLE) &&
           (LIGHT_KINDS == 1u << LIGHT_TRIANGLE || (light & LIGHT_IS_TRIANGLE) != 0u);
}

LightEntry fetchLightEntry(uint number) {
    const uvec4 r = ROW(lightTableRows, number);
    return LightEntry(r.x, r.y, uintBitsToFloat(r.z), r.w);
}

AliasColumn fetchAliasColumn(const Frame frame, uint number) {
    const uvec4 r = ROW(lightTableRows, frame.lightCount + number);
    return AliasColumn(uintBitsToFloat(r.x), r.y, r.z, r.w);
}

/// index: of all groups' nodes. Without a cone: row 1 is left out.
LightNode fetchLightNode(const Frame frame, uint index, bool withCone) {
    const uvec4 r0 = ROW(lightTableRows, frame.lightCount + index);
    uvec4 r1 = uvec4(0u);
    if (withCone) r1 = ROW(lightTableRows, 3u * frame.lightCount + index);
    return LightNode(uintBitsToFloat(r0.xyz), r0.w, r1.x, uintBitsToFloat(r1.y), r1.z, r1.w);
}

float radiusOf(LightNode node) { return uintBitsToFloat(node.radiusAndPower & 0xFFFF0000u); }
float powerOf(LightNode node) { return uintBitsToFloat(node.radiusAndPower << 16u); }

// Reads lights and the table that one of them is picked by (shaders/shared/light_types.h).

/// Rows that no kind of the scene has are not read.
LightRows fetchLightRows(uint light) {
    const uint row = LIGHT_ROWS * light;
    const bool two = samplesLightKind(LIGHT_QUAD) || samplesLightKind(LIGHT_POINT) ||
                     samplesLightKind(LIGHT_SPOT) || samplesLightKind(LIGHT_PROJECTOR) || HAS_ENVIRONMENT;
    LightRows l = LightRows(ROW(lightRows, row), uvec4(0u), uvec4(0u), uvec4(0u));
    l.row1 = ROW(lightRows, row + 1u);
    if (two) l.row2 = ROW(lightRows, row + 2u);
    if (samplesLightKind(LIGHT_QUAD) || samplesLightKind(LIGHT_SPOT) || samplesLightKind(LIGHT_PROJECTOR))
        l.row3 = ROW(lightRows, row + 3u);
    return l;
}

vec3 colorOf(LightRows l) { return uintBitsToFloat(l.header.xyz); }
uint kindOf(LightRows l) { return l.header.w & LIGHT_KIND_MASK; }
bool hasFlag(LightRows l, uint flag) { return (l.header.w & flag) != 0u; }

QuadLight quadLight(LightRows l) {
    return QuadLight(uintBitsToFloat(l.row1.xyz), uintBitsToFloat(l.row1.w),
                     uintBitsToFloat(l.row2.xyz), l.row2.w, uintBitsToFloat(l.row3.xyz), l.row3.w);
}

AmbientLight ambientLight(LightRows l) { return AmbientLight(uintBitsToFloat(l.row1.xyz), l.row1.w); }

EnvironmentLight environmentLight(LightRows l) {
    return EnvironmentLight(l.row1.x, l.row1.y, uintBitsToFloat(l.row1.z), uintBitsToFloat(l.row1.w),
                            uintBitsToFloat(l.row2.x), l.row2.y, l.row2.z, l.row2.w);
}

SphereLight sphereLight(LightRows l) {
    return SphereLight(uintBitsToFloat(l.row1.xyz), uintBitsToFloat(l.row1.w));
}

DirectionalLight directionalLight(LightRows l) {
    return DirectionalLight(uintBitsToFloat(l.row1.xyz), l.row1.w);
}

PointLight pointLight(LightRows l) {
    return PointLight(uintBitsToFloat(l.row1.xyz), uintBitsToFloat(l.row1.w),
                      uintBitsToFloat(l.row2.xyz), uintBitsToFloat(l.row2.w),
                      uintBitsToFloat(l.row3.xyz), uintBitsToFloat(l.row3.w));
}

ProjectorLight projectorLight(LightRows l) {
    return ProjectorLight(uintBitsToFloat(l.row1.xyz), uintBitsToFloat(l.row1.w),
                          uintBitsToFloat(l.row2.xyz), uintBitsToFloat(l.row2.w),
                          uintBitsToFloat(l.row3.xyz), l.row3.w);
}

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

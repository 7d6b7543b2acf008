// Sampling of lights: docs/theory/estimator.md has their densities. A kind of light is a file in this
// folder (or a part of one) and a row in the tables of shared/light_types.h.

#include "include/spherical.glsl"
#include "lights/light_rows.glsl"

/// A sampled segment from a shading point to a light.
struct LightSample {
    vec3 target;     ///< finite lights: point just before the light; else: unit direction
    bool infinite;   ///< target is a direction
    vec3 direction;  ///< unit, to the light
    vec3 radiance;   ///< times the inverse of the density (solid angle); 0: nothing arrives
    float inversePdf; ///< steradians; 0: of what no bounce can find
    uint sky; ///< what the sky brings is looked up on arrival: the portal that the sample aims at, or NO_PORTAL. Else NOT_SKY
};
const uint NO_PORTAL = 0xFFFFFFFFu, NOT_SKY = 0xFFFFFFFEu;

const LightSample NO_LIGHT_SAMPLE =
    LightSample(vec3(0.0, 0.0, 1.0), true, vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, NOT_SKY);

/// LightEntry::light of the only light; it has no meaning where that cannot be a triangle, since its rows are known then.
uint onlyLightReference() {
    return samplesLightKind(LIGHT_TRIANGLE) ? fetchLightEntry(0u).light : 0u;
}

#include "lights/choice_number.glsl"
#include "lights/light_tree.glsl"
#include "lights/light_roots.glsl"
#include "lights/light_sampler.glsl"
#include "lights/area_lights.glsl"
#include "lights/distant_lights.glsl"
#define SAMPLES_DELTA_LIGHTS
#include "shared/delta_lights.h"

OnlyLight findOnlyLight() {
    OnlyLight only;
    if (LIGHT_CHOICE != LIGHT_CHOICE_ONE) return only;
    const uint light = fetchLightEntry(0u).light;
    if (isTriangleLight(light)) return only;
    only.rows = fetchLightRows(light);
    if (samplesLightKind(LIGHT_QUAD)) {
        const QuadLight quad = quadLight(only.rows);
        only.normal = planeNormal(quad.edgeA, quad.edgeB);
    }
    return only;
}

/// s: faced forward; light: as LightEntry::light; u: where on the light. emitter: where that is, if on a triangle;
/// else its primitive is NO_PRIMITIVE. The sample's radiance lacks emissionFactorOf() that point: it is looked up
/// when the sample's ray arrives (path.glsl).
LightSample sampleLight(const Given given, SurfacePoint s, uint light, vec2 u, out MaterialPoint emitter) {
    emitter = MaterialPoint(0u, NO_PRIMITIVE, vec2(0.0));
    if (isTriangleLight(light)) return sampleTriangleLight(s, light, u, emitter);
    const LightRows rows = rowsOfLight(given, light);
    const uint kind = kindOf(rows);
#define SAMPLE_LIGHT(structure, function, fields, met, sample_) \
    if (met) return sample_;
    LIGHT_STRUCTURES(SAMPLE_LIGHT)
#undef SAMPLE_LIGHT
    return NO_LIGHT_SAMPLE;
}

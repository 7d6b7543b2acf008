// Sampling of lamps: docs/estimator.md has the table of densities.

#include "spherical.glsl"
#include "light_tree.glsl"

// ONE_LIGHT: read once, and what follows from it; llvmpipe moves nothing out of loops.
Light onlyLight;
vec3 onlyLightNormal; ///< LIGHT_QUAD

void findOnlyLight() {
    if (!ONE_LIGHT) return;
    onlyLight = fetchLight(0u);
    if (sceneHasLight(LIGHT_QUAD)) onlyLightNormal = planeNormal(onlyLight.edgeA, onlyLight.edgeB);
}

Light lightNumber(uint index) {
    if (ONE_LIGHT) return onlyLight;
    return fetchLight(index);
}

/// Unit normal of a LIGHT_QUAD.
vec3 quadNormal(Light light) {
    return ONE_LIGHT ? onlyLightNormal : planeNormal(light.edgeA, light.edgeB);
}

/// A sampled segment from a shading point to a light.
struct LightSample {
    vec3 target;     ///< finite lights: point just before the lamp; else: unit direction
    bool infinite;   ///< target is a direction
    vec3 direction;  ///< unit, to the light
    vec3 radiance;   ///< times the inverse of the density (solid angle); 0: nothing arrives
    float inversePdf; ///< steradians; 0: of what bounces do not find
};

/// Ends the segment d from `from` to the point p just before the lamp's surface, whatever the rounding of p
/// (pError, per component) and of the segment itself. n: unit normal of the lamp there; away: from `from`.
vec3 stopBefore(vec3 p, float pError, vec3 n, bool away, vec3 from, vec3 d) {
    const float segment = (4.0 * UNIT_ROUNDOFF) * largestComponent(abs(d) + abs(from));
    const float distance = offsetLength(pError + segment, n);
    return p + (away ? -distance : distance) * n;
}

/// Completes a sample taken uniformly on an area: radiance * area * cos / distance^2.
LightSample areaSample(SurfacePoint s, vec3 p, float pError, vec3 n, float area, Light light) {
    LightSample r;
    const vec3 from = litPoint(s), d = p - from;
    const float distance2 = dot(d, d);
    const float inverseDistance = inversesqrt(distance2);
    r.direction = d * inverseDistance;
    r.infinite = false;
    const float cosine = -dot(r.direction, n);
    r.target = stopBefore(p, pError, n, cosine < 0.0, from, d);
    // The CS184 renderer's density lacks one factor 1 / distance, and its lights have one side.
    const float falloff = CS184 ? inverseDistance : inverseDistance * inverseDistance;
    const bool emits = CS184 || light.bothSides == 0u ? cosine > 0.0 : cosine != 0.0;
    r.inversePdf = area * abs(cosine) * falloff;
    r.radiance = emits && distance2 > 0.0 ? light.color * r.inversePdf : vec3(0.0);
    return r;
}

/// Completes a sample taken uniformly by direction: radiance * solid angle. z: distance of the lamp's
/// plane on the side n points from. One that rounding may have put there gives no light, as a surface
/// in the lamp's own plane gets none.
LightSample angleSample(SurfacePoint s, vec3 p, float pError, vec3 n, float z, float angle,
                        Light light) {
    LightSample r;
    const vec3 from = litPoint(s), d = p - from;
    const float distance2 = dot(d, d);
    r.direction = d * inversesqrt(max(distance2, TINY));
    r.infinite = false;
    r.target = stopBefore(p, pError, n, z > 0.0, from, d);
    const bool apart = abs(z) > (s.error + pError) * dot(abs(n), vec3(1.0)) && distance2 > 0.0;
    const bool emits = apart && (light.bothSides != 0u || z < 0.0);
    r.radiance = emits ? light.color * angle : vec3(0.0);
    r.inversePdf = (light.flags & LIGHT_FOUND_BY_BOUNCES) != 0u ? angle : 0.0;
    return r;
}

LightSample sampleQuadByAngle(SurfacePoint s, Light light, vec2 u) {
    const vec3 n = quadNormal(light), v0 = light.position - litPoint(s);
    const float z = dot(v0, n);
    const SolidAngleSample a =
        sampleQuadByAngle(v0, light.edgeA, light.edgeB, z, light.area, u);
    const vec3 alongA = a.weights.x * light.edgeA, alongB = a.weights.y * light.edgeB;
    const float error = interpolationError(abs(light.position) + abs(alongA) + abs(alongB));
    return angleSample(s, light.position + alongA + alongB, error, n, z, a.angle, light);
}

LightSample sampleQuad(SurfacePoint s, Light light, vec2 u) {
    if (!CS184) return sampleQuadByAngle(s, light, u);
    const vec3 p = light.position + u.x * light.edgeA + u.y * light.edgeB;
    const float error = interpolationError(abs(light.position) + abs(u.x * light.edgeA) +
                                          abs(u.y * light.edgeB));
    return areaSample(s, p, error, quadNormal(light), light.area, light);
}

/// A triangle of an emissive mesh, or of all of them, picked by u: z and w.
struct PickedTriangle {
    PlacedPrimitive triangle;
    float probability;
    float doubleArea;
    vec3 normal; ///< unit
};

PickedTriangle placed(uint place) {
    PickedTriangle t;
    t.triangle = fetchPlace(place);
    const vec3 a = t.triangle.v1 - t.triangle.v0, b = t.triangle.v2 - t.triangle.v0;
    t.normal = planeNormal(a, b);
    t.doubleArea = dot(cross(a, b), t.normal);
    return t;
}

/// By an alias table; `sum` is that of its weights: areas, or powers.
PickedTriangle pickTriangle(uint firstEntry, uint entryCount, float sum, vec2 u,
                            inout Light light) {
    const uint column = min(uint(u.x * float(entryCount)), entryCount - 1u);
    const EmitterEntry entry = fetchEmitterEntry(firstEntry + column);
    PickedTriangle t = placed(u.y < entry.threshold ? entry.place : entry.alias);
    float weight = 0.5 * t.doubleArea;
    if (LIGHT_CHOICE != LIGHT_CHOICE_AREA) {
        const Material m = fetchMaterial(materialOf(fetchPrimitive(t.triangle.primitive)));
        light.color = m.emission;
        light.bothSides = m.emitsBothSides;
        weight *= trianglePower(m);
    }
    t.probability = LIGHT_CHOICE == LIGHT_CHOICE_UNIFORM ? 1.0 / float(entryCount) : weight / sum;
    return t;
}

PickedTriangle pickTriangle(SurfacePoint s, inout Light light, vec2 u) {
    if (LIGHT_CHOICE != LIGHT_CHOICE_TREE)
        return pickTriangle(light.firstEntry, light.entryCount, light.area, u, light);
    const PickedLeaf leaf = walkLightTree(light.firstEntry, litPoint(s), shadingNormal(s), u);
    const float column = leaf.u * float(leaf.entryCount);
    PickedTriangle t = pickTriangle(leaf.firstEntry, leaf.entryCount, leaf.power,
                                    vec2(leaf.u, fract(column)), light);
    t.probability *= leaf.probability;
    return t;
}

/// u: x, y for the direction, z and w for the triangle.
LightSample sampleMesh(SurfacePoint s, Light light, vec4 u) {
    const PickedTriangle t = pickTriangle(s, light, u.zw);
    const PlacedPrimitive p = t.triangle;
    const vec3 v0 = p.v0 - litPoint(s);
    const float z = dot(v0, t.normal);
    const SolidAngleSample a =
        sampleTriangleByAngle(v0, p.v1 - p.v0, p.v2 - p.v0, z, t.doubleArea, u.xy);
    const float b0 = 1.0 - a.weights.x - a.weights.y;
    const vec3 b0v0 = b0 * p.v0, b1v1 = a.weights.x * p.v1, b2v2 = a.weights.y * p.v2;
    const float error = interpolationError(abs(b0v0) + abs(b1v1) + abs(b2v2));
    const float angle = t.probability > 0.0 ? a.angle / t.probability : 0.0;
    return angleSample(s, b0v0 + b1v1 + b2v2, error, t.normal, z, angle, light);
}

/// From outside: uniform in the cone the sphere subtends (Shirley, Wang and Zimmerman 1996), with
/// 1 - cos computed as sin^2 / (1 + cos), stable for small cones; from inside: uniform on the area.
LightSample sampleSphere(SurfacePoint s, Light light, vec2 u) {
    const float radius = light.edgeA.x;
    // A point on the sphere itself counts as on the side of wo.
    const vec3 from = leave(s, s.wo, false);
    const vec3 toCenter = light.position - from;
    const float distance2 = dot(toCenter, toCenter);
    const float sin2Max = radius * radius / distance2;
    const float error = sphereError(light.position, radius);
    if (!(sin2Max < 1.0)) {
        const vec3 n = vec3(2.0 * sqrt(u.x * (1.0 - u.x)) * cosSin(4.0 * u.y), 1.0 - 2.0 * u.x);
        return areaSample(s, light.position + radius * n, error, n,
                          4.0 * PI * radius * radius, light);
    }
    const float oneMinusCosMax = sin2Max / (1.0 + sqrt(1.0 - sin2Max));
    const float oneMinusCos = u.x * oneMinusCosMax;
    const float cosine = 1.0 - oneMinusCos;
    const float sin2 = oneMinusCos * (2.0 - oneMinusCos);
    const float distance = sqrt(distance2);
    const ShadingFrame cone = makeFrame(toCenter / distance);
    const vec3 w = toWorld(cone, vec3(sqrt(sin2) * cosSin(4.0 * u.y), cosine));
    // The near intersection of the direction with the sphere, put back on its surface.
    const float t = distance * cosine - sqrt(max(radius * radius - distance2 * sin2, 0.0));
    const vec3 n = unit(from + t * w - light.position);
    LightSample r;
    r.direction = w;
    r.infinite = false;
    const vec3 p = light.position + radius * n, d = p - from;
    r.target = stopBefore(p, error, n, dot(n, d) > 0.0, from, d);
    r.inversePdf = 2.0 * PI * oneMinusCosMax;
    r.radiance = light.color * r.inversePdf;
    return r;
}

LightSample sampleAmbient(SurfacePoint s, Light light, vec2 u) {
    LightSample r;
    const vec3 w = sampleUniformHemisphere(u);
    r.direction = toWorld(makeFrame(shadingNormal(s)), w);
    if ((light.flags & LIGHT_UPPER_HEMISPHERE_ONLY) != 0u) r.direction = w.xzy; // y is up
    r.infinite = true;
    r.target = r.direction;
    r.inversePdf = 2.0 * PI;
    r.radiance = light.color * r.inversePdf;
    return r;
}

/// The share of the way to a point light, at its end, where nothing shades: 2^-16, 256 roundings.
/// A light placed in the very plane of a surface (lamps often are) would else be shaded by chance.
const float POINT_LIGHT_GAP = 1.52587890625e-5;

LightSample sampleDelta(SurfacePoint s, Light light) {
    LightSample r;
    if (light.kind == LIGHT_DIRECTIONAL)
        return LightSample(light.position, true, light.position, light.color, 0.0);
    const vec3 d = light.position - litPoint(s);
    const float distance2 = dot(d, d), distance = sqrt(distance2);
    r.inversePdf = 0.0;
    r.direction = d / distance;
    r.infinite = false;
    r.target = light.position - POINT_LIGHT_GAP * d;
    const float attenuation =
        light.edgeB.x + light.edgeB.y * distance + light.edgeB.z * distance2;
    r.radiance = distance2 > 0.0 ? light.color / attenuation : vec3(0.0);
    if (isLight(light.kind, LIGHT_SPOT)) {
        const float cosine = -dot(r.direction, light.edgeA);
        const float falloff =
            light.falloffExponent == 0.0 ? 1.0 : pow(max(cosine, 0.0), light.falloffExponent);
        r.radiance *= cosine >= light.cosCutoff ? falloff : 0.0;
    }
    return r;
}

LightSample sampleLight(SurfacePoint s, Light light, vec4 u) {
    if (isLight(light.kind, LIGHT_QUAD)) return sampleQuad(s, light, u.xy);
    if (isLight(light.kind, LIGHT_MESH)) return sampleMesh(s, light, u);
    if (isLight(light.kind, LIGHT_SPHERE))
        return sampleSphere(s, light, u.xy);
    if (isLight(light.kind, LIGHT_AMBIENT))
        return sampleAmbient(s, light, u.xy);
    if (sceneHasLight(LIGHT_DIRECTIONAL) || sceneHasLight(LIGHT_POINT) ||
        sceneHasLight(LIGHT_SPOT))
        return sampleDelta(s, light);
    return LightSample(vec3(0.0), true, vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0);
}

/// Radiance that all ambient lights send from direction w (unit, away from the surface).
vec3 ambientRadiance(vec3 w) {
    vec3 sum = vec3(0.0);
    if (!sceneHasLight(LIGHT_AMBIENT)) return sum;
    for (uint i = 0u; i < frame.areaLights; ++i) {
        const Light light = fetchLight(i);
        const bool reaches = (light.flags & LIGHT_UPPER_HEMISPHERE_ONLY) == 0u || w.y > 0.0;
        if (light.kind == LIGHT_AMBIENT && reaches) sum += light.color;
    }
    return sum;
}

// Multiple importance sampling (Veach and Guibas 1995) of lamps, at rough metals: a narrow lobe finds a
// large lamp better than points on the lamp find the lobe, a wide lobe finds a small lamp worse. The
// power heuristic with exponent 2. Diffuse surfaces are left to light samples, whose noise is that of one
// cosine there; delta materials to bounces.

/// Whether a bounce from a surface of this material shares finding lamps with its light samples.
bool combines(Material m) {
    return USE_MIS && isMaterial(m.kind, MATERIAL_MICROFACET);
}

/// 1 / (1 + (q / p)^2).
float powerHeuristic(float qOverP) { return 1.0 / (1.0 + qOverP * qOverP); }

/// Of a light sample that could also have come from a bounce of density bouncePdf. inversePdf: of one of
/// LIGHT_SAMPLES samples (steradians); 0: no bounce finds that light.
float lightSampleWeight(float inversePdf, float bouncePdf) {
    return powerHeuristic(bouncePdf * inversePdf / float(LIGHT_SAMPLES));
}

/// Of light found by a bounce, bouncePdf > 0.
float bounceWeight(float inversePdf, float bouncePdf) {
    return powerHeuristic(float(LIGHT_SAMPLES) / max(bouncePdf * inversePdf, TINY));
}

/// Solid angle of a triangle from the origin; v0, a, b as in sampleTriangleByAngle.
float triangleAngle(vec3 v0, vec3 a, vec3 b) {
    const vec3 n = planeNormal(a, b);
    return solidAngle(seeTriangle(see(v0), see(v0 + a), see(v0 + b), dot(v0, n),
                                  dot(cross(a, b), n)));
}

/// Inverse of the density (steradians) with which one light sample from `from` takes the point that ray t
/// has hit; as in sampleLight(). 0: no light sample does. The ray starts within rounding of where light
/// samples start; the weights of both add up to 1 but for that share of the lamp's distance.
float lightSampleInversePdf(Traversal t, uint lightIndex) {
    const vec3 from = t.origin;
    const Light light = lightNumber(lightIndex);
    if (isLight(light.kind, LIGHT_QUAD)) {
        const vec3 v0 = light.position - from, a = light.edgeA, b = light.edgeB;
        return triangleAngle(v0, a, b) + triangleAngle(v0 + a + b, -a, -b);
    }
    const PlacedPrimitive place = fetchPlace(t.hitPrimitive);
    if (isLight(light.kind, LIGHT_MESH)) {
        const vec3 a = place.v1 - place.v0, b = place.v2 - place.v0;
        const float share = 0.5 * length(cross(a, b)) / light.area;
        return triangleAngle(place.v0 - from, a, b) / max(share, TINY);
    }
    if (!sceneHasLight(LIGHT_SPHERE)) return 0.0;
    const float radius = light.edgeA.x;
    const vec3 toCenter = light.position - from;
    const float sin2Max = radius * radius / dot(toCenter, toCenter);
    if (sin2Max < 1.0) return 2.0 * PI * sin2Max / (1.0 + sqrt(1.0 - sin2Max));
    const vec3 d = t.tMax * t.direction;
    const float cosine = abs(dot(t.direction, unit(d - toCenter)));
    return 4.0 * PI * radius * radius * cosine / max(dot(d, d), TINY);
}

/// Ambient lights: each is sampled uniformly on a hemisphere.
const float AMBIENT_INVERSE_PDF = 2.0 * PI;

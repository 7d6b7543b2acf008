// Lights with a surface: parallelograms, triangles, spheres. Sampled uniformly by the direction they are
// seen in (docs/theory/numerics.md, "Solid angles"), so that neither distance nor slant is left in the noise.

/// Ends the segment d from `from` to the point p just before the light's surface, whatever the rounding of
/// p (pError, per component) and of the segment itself. n: unit normal of the light there; away: n points
/// away from `from`.
vec3 stopBefore(vec3 p, float pError, vec3 n, bool away, vec3 from, vec3 d) {
    const float segment = (4.0 * UNIT_ROUNDOFF) * largestComponent(abs(d) + abs(from));
    const float distance = offsetLength(pError + segment, n);
    return p + (away ? -distance : distance) * n;
}

/// What a light emits, and where: radiance, on the side of its normal or on both.
struct Emission {
    vec3 radiance;
    bool bothSides;
};

Emission emissionOf(LightRows l) { return Emission(colorOf(l), hasFlag(l, LIGHT_BOTH_SIDES)); }

/// Completes a sample taken uniformly on an area: radiance * area * cos / distance^2.
LightSample areaSample(SurfacePoint s, vec3 p, float pError, vec3 n, float area, Emission e) {
    LightSample r = NO_LIGHT_SAMPLE;
    const vec3 from = litPoint(s), d = p - from;
    const float distance2 = dot(d, d);
    const float inverseDistance = inversesqrt(distance2);
    r.direction = d * inverseDistance;
    r.infinite = false;
    const float cosine = -dot(r.direction, n);
    r.target = stopBefore(p, pError, n, cosine < 0.0, from, d);
    const bool emits = e.bothSides ? cosine != 0.0 : cosine > 0.0;
    r.inversePdf = area * abs(cosine) * areaFalloff(inverseDistance);
    r.radiance = emits && distance2 > 0.0 ? e.radiance * r.inversePdf : vec3(0.0);
    return r;
}

/// Completes a sample taken uniformly by direction: radiance * solid angle. z: distance of the light's
/// plane on the side n points from. One that rounding may have put there gives no light, as a surface
/// in the light's own plane gets none.
LightSample angleSample(SurfacePoint s, vec3 p, float pError, vec3 n, float z, float angle,
                        Emission e) {
    LightSample r = NO_LIGHT_SAMPLE;
    const vec3 from = litPoint(s), d = p - from;
    const float distance2 = dot(d, d);
    r.direction = d * inversesqrt(max(distance2, TINY));
    r.infinite = false;
    r.target = stopBefore(p, pError, n, z > 0.0, from, d);
    const bool apart = abs(z) > (s.error + pError) * dot(abs(n), vec3(1.0)) && distance2 > 0.0;
    const bool emits = apart && (e.bothSides || z < 0.0);
    r.radiance = emits ? e.radiance * angle : vec3(0.0);
    r.inversePdf = angle;
    return r;
}

// --- Parallelograms ---------------------------------------------------------------------------

/// Unit.
vec3 quadNormal(const OnlyLight onlyLight, QuadLight q) {
    return LIGHT_CHOICE == LIGHT_CHOICE_ONE ? onlyLight.normal : planeNormal(q.edgeA, q.edgeB);
}

LightSample sampleQuadLight(const OnlyLight onlyLight, SurfacePoint s, LightRows rows, vec2 u) {
    const QuadLight q = quadLight(rows);
    const vec3 n = quadNormal(onlyLight, q), v0 = q.corner - litPoint(s);
    const float z = dot(v0, n);
    SolidAngleSample a = SolidAngleSample(u, 0.0);
    if (INVERSE_SQUARE_FALLOFF) a = sampleQuadByAngle(v0, q.edgeA, q.edgeB, z, q.area, u);
    const vec3 alongA = a.weights.x * q.edgeA, alongB = a.weights.y * q.edgeB;
    const vec3 p = q.corner + alongA + alongB;
    const float error = interpolationError(abs(q.corner) + abs(alongA) + abs(alongB));
    if (INVERSE_SQUARE_FALLOFF) return angleSample(s, p, error, n, z, a.angle, emissionOf(rows));
    return areaSample(s, p, error, n, q.area, emissionOf(rows));
}

// --- Triangles ----------------------------------------------------------------------------------

/// emitter: see sampleLight().
LightSample sampleTriangleLight(SurfacePoint s, uint light, vec2 u, out MaterialPoint emitter) {
    const PlacedPrimitive t = fetchPlace(light & ~LIGHT_IS_TRIANGLE);
    const uint materialRow = materialOf(fetchPrimitive(t.primitive));
    const Material m = fetchMaterial(materialRow);
    const vec3 edgeA = t.v1 - t.v0, edgeB = t.v2 - t.v0, n = planeNormal(edgeA, edgeB);
    const vec3 v0 = t.v0 - litPoint(s);
    const float z = dot(v0, n);
    const SolidAngleSample a =
        sampleTriangleByAngle(v0, edgeA, edgeB, z, dot(cross(edgeA, edgeB), n), u);
    const float b0 = 1.0 - a.weights.x - a.weights.y;
    const vec3 b0v0 = b0 * t.v0, b1v1 = a.weights.x * t.v1, b2v2 = a.weights.y * t.v2;
    const float error = interpolationError(abs(b0v0) + abs(b1v1) + abs(b2v2));
    emitter = MaterialPoint(materialRow, t.primitive, a.weights.xy);
    return angleSample(s, b0v0 + b1v1 + b2v2, error, n, z, a.angle,
                       Emission(emissionOf(m), emitsBothSides(m)));
}

// --- Spheres --------------------------------------------------------------------------------------

/// From outside: uniform in the cone the sphere subtends (Shirley, Wang and Zimmerman 1996), with
/// 1 - cos computed as sin^2 / (1 + cos), stable for small cones; from inside: uniform on the area.
LightSample sampleSphereLight(SurfacePoint s, LightRows rows, vec2 u) {
    const SphereLight l = sphereLight(rows);
    // A point on the sphere itself counts as on the side of wo.
    const vec3 from = leave(s, s.wo, false);
    const vec3 toCenter = l.center - from;
    const float distance2 = dot(toCenter, toCenter);
    const float sin2Max = l.radius * l.radius / distance2;
    const float error = sphereError(l.center, l.radius);
    if (!(sin2Max < 1.0)) {
        const vec3 n = vec3(2.0 * sqrt(u.x * (1.0 - u.x)) * cosSin(4.0 * u.y), 1.0 - 2.0 * u.x);
        return areaSample(s, l.center + l.radius * n, error, n, 4.0 * PI * l.radius * l.radius,
                          emissionOf(rows));
    }
    const float oneMinusCosMax = sin2Max / (1.0 + sqrt(1.0 - sin2Max));
    const float oneMinusCos = u.x * oneMinusCosMax;
    const float cosine = 1.0 - oneMinusCos;
    const float sin2 = oneMinusCos * (2.0 - oneMinusCos);
    const float distance = sqrt(distance2);
    const ShadingFrame cone = makeFrame(toCenter / distance);
    const vec3 w = toWorld(cone, vec3(sqrt(sin2) * cosSin(4.0 * u.y), cosine));
    // The near intersection of the direction with the sphere, put back on its surface.
    const float t = distance * cosine - sqrt(max(l.radius * l.radius - distance2 * sin2, 0.0));
    const vec3 n = unit(from + t * w - l.center);
    LightSample r = NO_LIGHT_SAMPLE;
    r.direction = w;
    r.infinite = false;
    const vec3 p = l.center + l.radius * n, d = p - from;
    r.target = stopBefore(p, error, n, dot(n, d) > 0.0, from, d);
    r.inversePdf = 2.0 * PI * oneMinusCosMax;
    r.radiance = colorOf(rows) * r.inversePdf;
    return r;
}

// --- The same densities, where a bounce has found the light ------------------------------------------

/// Solid angle of a triangle from the origin; v0, a, b as in sampleTriangleByAngle.
float triangleAngle(vec3 v0, vec3 a, vec3 b) {
    const vec3 n = planeNormal(a, b);
    return solidAngle(seeTriangle(see(v0), see(v0 + a), see(v0 + b), dot(v0, n),
                                  dot(cross(a, b), n)));
}

float sphereInversePdf(Traversal t, SphereLight l) {
    const vec3 toCenter = l.center - t.origin;
    const float sin2Max = l.radius * l.radius / dot(toCenter, toCenter);
    if (sin2Max < 1.0) return 2.0 * PI * sin2Max / (1.0 + sqrt(1.0 - sin2Max));
    const vec3 d = t.tMax * t.direction;
    const float cosine = abs(dot(t.direction, unit(d - toCenter)));
    return 4.0 * PI * l.radius * l.radius * cosine / max(dot(d, d), TINY);
}

/// Inverse of the density (steradians) with which a sample of this light, taken from where ray t starts,
/// goes to the point that t has hit; as in sampleLight(). The ray starts within rounding of where light
/// samples start; the MIS weights of both add up to 1 but for that share of the light's distance.
float areaLightInversePdf(const Given given, Traversal t, PlacedPrimitive place, uint light) {
    if (isTriangleLight(light))
        return triangleAngle(place.v0 - t.origin, place.v1 - place.v0, place.v2 - place.v0);
    const LightRows rows = rowsOfLight(given, light);
    if (isLight(kindOf(rows), LIGHT_QUAD)) {
        const QuadLight q = quadLight(rows);
        const vec3 v0 = q.corner - t.origin;
        return triangleAngle(v0, q.edgeA, q.edgeB) +
               triangleAngle(v0 + q.edgeA + q.edgeB, -q.edgeA, -q.edgeB);
    }
    if (samplesLightKind(LIGHT_SPHERE)) return sphereInversePdf(t, sphereLight(rows));
    return 0.0;
}

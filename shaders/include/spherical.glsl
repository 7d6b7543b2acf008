// Triangles and parallelograms as seen from a point, sampled uniformly by solid angle (Arvo 1995),
// which takes both the distance and the slant of a light out of the noise. Angles never come from
// the arc cosine of a sum close to 1: solid angles have the numerator of van Oosterom and Strackee
// (1983), a volume, and angles between corners come from their chord. So nothing cancels,
// whether the light is far or touched (docs/theory/numerics.md, "Solid angles").

/// Angle in [0, pi] of the point (x, y), y >= 0: polynomial 4.4.49 of Abramowitz and Stegun, of
/// relative error below 1e-7 on every device (docs/theory/kernel.md, "Arithmetic").
float angleOf(float y, float x) {
    const float far = larger(abs(x), y), near = smaller(abs(x), y);
    const float q = near / max(far, TINY), q2 = q * q;
    const float small = q +
        q * q2 * (-0.3333314528 + q2 * (0.1999355085 + q2 * (-0.1420889944 + q2 * (0.1065626393 +
        q2 * (-0.0752896400 + q2 * (0.0429096138 + q2 * (-0.0161657367 + q2 * 0.0028662257)))))));
    const float angle = y > abs(x) ? 0.5 * PI - small : small;
    return x < 0.0 ? PI - angle : angle;
}

/// A corner as seen from the point.
struct SeenCorner {
    vec3 direction; ///< unit
    float distance, inverse; ///< its reciprocal
};

SeenCorner see(vec3 toCorner) {
    const float distance2 = max(dot(toCorner, toCorner), TINY), inverse = inversesqrt(distance2);
    return SeenCorner(toCorner * inverse, distance2 * inverse, inverse);
}

/// A triangle as seen: `pivot` and the edge that is swept from `start` to `end`.
struct SeenTriangle {
    SeenCorner pivot, start, end;
    float volume; ///< of the unit directions' parallelepiped: |det|
};

/// volume = |z| doubleArea / (product of distances), z being the distance of the plane.
SeenTriangle seeTriangle(SeenCorner pivot, SeenCorner start, SeenCorner end, float z,
                         float doubleArea) {
    const float volume = (abs(z) * pivot.inverse) * ((doubleArea * start.inverse) * end.inverse);
    return SeenTriangle(pivot, start, end, volume);
}

/// Steradians, in [0, 2 pi] (van Oosterom and Strackee 1983).
float solidAngle(SeenTriangle t) {
    const float denominator = 1.0 + dot(t.pivot.direction, t.start.direction) +
                              dot(t.start.direction, t.end.direction) +
                              dot(t.pivot.direction, t.end.direction);
    return 2.0 * angleOf(t.volume, denominator);
}

/// sin^2 of half the angle between two unit vectors.
float halfChord2(vec3 a, vec3 b) { return 0.25 * dot(a - b, a - b); }

/// The weights of `start` and `end` of a point whose direction is uniform in the triangle. angle: what
/// the sweep has covered, in [0, solidAngle(t)]; v: in [0, 1), the way from the pivot.
///
/// The sweep ends on the edge at an angle theta from `start` such that pivot, start and that point
/// span `angle`: van Oosterom and Strackee's formula solved for tan(theta / 2). Then 1 - cos is
/// uniform between the pivot and that point.
vec2 sampleSeenTriangle(SeenTriangle t, float angle, float v) {
    const vec2 half_ = cosSin(INV_PI * angle);
    const float c = half_.x, s = half_.y;
    const float startPivot = dot(t.start.direction, t.pivot.direction);
    const float endPivot = dot(t.end.direction, t.pivot.direction);
    const float edge2 = halfChord2(t.start.direction, t.end.direction);
    const float cosEdge = 1.0 - 2.0 * edge2, sin2Edge = 4.0 * edge2 * (1.0 - edge2);
    // tan(theta / 2) over the sine of the whole edge.
    const float tangent = s * (1.0 + startPivot) /
                          max(c * t.volume - s * (endPivot - startPivot * cosEdge), TINY);
    const float swept = 2.0 * tangent * t.start.distance;
    const float left =
        t.end.distance * (1.0 - tangent * tangent * sin2Edge - 2.0 * tangent * cosEdge);
    const float along = clamp(swept / max(swept + left, TINY), 0.0, 1.0);

    const SeenCorner swung = see(mix(t.start.direction * t.start.distance,
                                     t.end.direction * t.end.distance, along));
    const float arc2 = halfChord2(t.pivot.direction, swung.direction);
    // Sines over that of half the arc, so that a short arc divides nothing by nothing.
    const float sine = sqrt(v * (1.0 - v * arc2)) * t.pivot.distance;
    const float rest = swung.distance * (sqrt(1.0 - arc2) * (1.0 - 2.0 * v * arc2) -
                                         (1.0 - 2.0 * arc2) * sqrt(v * (1.0 - v * arc2)));
    const float out_ = clamp(sine / max(sine + rest, TINY), 0.0, 1.0);
    return out_ * vec2(1.0 - along, along);
}

/// A point chosen uniformly by direction.
struct SolidAngleSample {
    vec2 weights; ///< of the two edges from the first corner
    float angle;  ///< steradians that the whole takes up: 1 / pdf
};

/// v0 and edges a, b as seen from the origin; z: distance of the plane; doubleArea: |a x b|.
SolidAngleSample sampleTriangleByAngle(vec3 v0, vec3 a, vec3 b, float z, float doubleArea, vec2 u) {
    const SeenTriangle t = seeTriangle(see(v0), see(v0 + a), see(v0 + b), z, doubleArea);
    const float angle = solidAngle(t);
    return SolidAngleSample(sampleSeenTriangle(t, u.x * angle, u.y), angle);
}

/// Samples the parallelogram of v0 and the edges a, b by direction: it is swept about v0 in two triangles.
SolidAngleSample sampleQuadByAngle(vec3 v0, vec3 a, vec3 b, float z, float area, vec2 u) {
    const SeenCorner pivot = see(v0), afterA = see(v0 + a), far = see(v0 + a + b),
                     afterB = see(v0 + b);
    SeenTriangle t = seeTriangle(pivot, afterA, far, z, area);
    const SeenTriangle second = seeTriangle(pivot, far, afterB, z, area);
    const float first = solidAngle(t), angle = first + solidAngle(second);
    float swept = u.x * angle;
    const bool inSecond = swept >= first;
    if (inSecond) {
        t = second;
        swept -= first;
    }
    const vec2 w = sampleSeenTriangle(t, swept, u.y);
    return SolidAngleSample(inSecond ? vec2(w.x, w.x + w.y) : vec2(w.x + w.y, w.y), angle);
}

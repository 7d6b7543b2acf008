// Light samples that meet clear glass (docs/theory/estimator.md, "Light through glass"): they go on through it, bent, as a
// path that is let through by every surface, until they have found the light that they were meant for or anything else.
// Bounces that go through clear glass may find the same light; both are combined as if there were no glass, by the
// direction in which they have left the last surface that scatters light into many. Whatever is asked of that direction, it
// is asked of both, so that their weights add up to 1.

/// Glass that light goes through in one direction, whatever else the surface does. Where it is partly not there, rays of
/// light samples pass it as they pass all that is, and no more.
bool isClear(Material m) { return LIGHT_THROUGH_GLASS && (lobesOf(m) & LOBE_DELTA_TRANSMISSION) != 0u; }

/// What is known of a ray since it has left a surface that takes light samples.
struct ThroughGlass {
    vec3 direction; ///< in which the path ray, or the light sample, has left it; unit
    bool isFromLit; ///< the path ray: light samples were taken there
    uint panes;     ///< surfaces of glass that the path ray has gone through since

    // What is known of the last light sample:
    uint light;        ///< as LightEntry::light
    vec3 share;        ///< what it brings of each radiance that it finds; 0: of what no ray finds
    bool isUnderWay;   ///< it is on its way through glass, and the path waits at its surface:
    SurfacePoint surface;
    Material material;
    vec3 throughput;
    uint bounce;
    Filling filling;
};

/// Whether the ray through the origin in direction w meets the triangle or parallelogram with this corner and these
/// edges. The signs of three or four volumes say so at every scale.
bool meets(vec3 corner, vec3 edgeA, vec3 edgeB, bool isTriangle, vec3 w) {
    const vec3 a = corner + edgeA, b = corner + edgeB, c = a + edgeB;
    const float first = dot(w, cross(corner, a)), last = dot(w, cross(b, corner));
    float most = max(first, last), least = min(first, last);
    if (isTriangle) {
        const float between = dot(w, cross(a, b));
        most = max(most, between);
        least = min(least, between);
    } else {
        const float second = dot(w, cross(a, c)), third = dot(w, cross(c, b));
        most = max(most, max(second, third));
        least = min(least, min(second, third));
    }
    const vec3 n = planeNormal(edgeA, edgeB);
    return (least >= 0.0 || most <= 0.0) && dot(w, n) * dot(corner, n) > 0.0;
}

/// Whether a light sample from p goes to this light, of which `place` is a part, in direction w, were there no glass.
bool leadsTo(const Given given, PlacedPrimitive place, uint light, vec3 p, vec3 w) {
    if (isTriangleLight(light)) return meets(place.v0 - p, place.v1 - place.v0, place.v2 - place.v0, true, w);
    const LightRows rows = rowsOfLight(given, light);
    bool leads = false;
    if (isLight(kindOf(rows), LIGHT_QUAD)) {
        const QuadLight q = quadLight(rows);
        leads = meets(q.corner - p, q.edgeA, q.edgeB, false, w);
    }
    if (samplesLightKind(LIGHT_SPHERE) && isLight(kindOf(rows), LIGHT_SPHERE)) {
        const SphereLight l = sphereLight(rows);
        const vec3 toCenter = l.center - p, aside = cross(toCenter, w);
        const float radius2 = l.radius * l.radius;
        leads = dot(toCenter, toCenter) > radius2 && dot(aside, aside) <= radius2 && dot(toCenter, w) > 0.0;
    }
    return leads;
}

// Light samples to the sky that aim at portals: rectangles through which a room sees it (docs/theory/estimator.md,
// "Portals"). They share directions with samples by the sky's own density, by the balance heuristic.

Portal portalOf(const Frame frame, uint number) {
    const uint row = PORTAL_ROWS * number;
    const vec4 a = frame.portals[row + 1u], b = frame.portals[row + 2u], normal = frame.portals[row + 3u];
    return Portal(frame.portals[row].xyz, a.xyz, b.xyz, vec2(a.w, b.w), normal.xyz, frame.portals[row + 4u].xyz, normal.w);
}

/// As seen from a point: `corner` is relative to it.
struct SeenPortal {
    uint index;
    vec3 corner, edgeA, edgeB;
    float weight;   ///< with which it is chosen; 0: it does not shine on the surface
};

/// weight: an approximation of the solid angle that the portal takes up (steradians), times a bound of the cosine at the
/// surface with the unit normal n; in a medium (isNowhere(n)) the angle alone. Both densities below have the same weights,
/// so that these decide about noise and put no bias on the picture.
SeenPortal seePortal(Portal portal, uint index, vec3 p, vec3 n) {
    SeenPortal s;
    s.index = index;
    s.corner = portal.corner - p;
    s.edgeA = portal.edgeA;
    s.edgeB = portal.edgeB;
    const vec3 middle = s.corner + portal.half_;
    const float inverse = inversesqrt(max(dot(middle, middle), TINY));
    const float height = -dot(portal.normal, middle);
    const float angle = min(height * inverse * inverse * inverse, 2.0 * PI);
    const float cosine = isNowhere(n) ? 1.0 : clamp((dot(n, middle) + portal.reach) * inverse, 0.0, 1.0);
    s.weight = max(angle, 0.0) * cosine;
    return s;
}

bool isPassed(Portal portal, SeenPortal s, vec3 w) {
    const float t = dot(s.corner, portal.normal) / dot(w, portal.normal);
    const vec3 at = t * w - s.corner;
    const vec2 place = vec2(dot(at, s.edgeA), dot(at, s.edgeB)) * portal.perSquare;
    return s.weight > 0.0 && dot(w, portal.normal) < 0.0 && t > 0.0 && min(place.x, place.y) >= 0.0 && max(place.x, place.y) <= 1.0;
}

/// Chooses one of them by weight. u: a number in [0, 1); uniform again afterwards. weight 0: none shines on the surface.
SeenPortal choosePortal(const Portals portals, vec3 p, vec3 n, inout float u) {
    SeenPortal chosen;
    chosen.weight = 0.0;
    float total = 0.0;
    for (uint i = 0u; i < PORTALS; ++i) {
        const SeenPortal s = seePortal(portals.all[i], i, p, n);
        total += s.weight;
        const float part = s.weight / max(total, TINY);
        const bool takes = u < part;
        u = min(takes ? u / max(part, TINY) : (u - part) / max(1.0 - part, TINY), 1.0 - UNIT_ROUNDOFF);
        if (takes) chosen = s;
    }
    return chosen;
}

/// How likely samples that aim at portals take a direction.
struct PortalDensity {
    uint portal;  ///< the first that the direction passes, to which it belongs; NO_PORTAL: none
    float pdf;    ///< by solid angle
    bool isAimed; ///< samples from here aim at any
};

PortalDensity portalDensity(const Portals portals, vec3 p, vec3 n, vec3 w) {
    SeenPortal passed;
    passed.index = NO_PORTAL;
    passed.weight = 0.0;
    float total = 0.0;
    for (uint i = 0u; i < PORTALS; ++i) {
        const SeenPortal s = seePortal(portals.all[i], i, p, n);
        total += s.weight;
        if (passed.index == NO_PORTAL && isPassed(portals.all[i], s, w)) passed = s;
    }
    PortalDensity d = PortalDensity(passed.index, 0.0, total > 0.0);
    if (passed.index != NO_PORTAL) {
        const float angle = triangleAngle(passed.corner, passed.edgeA, passed.edgeB) +
                            triangleAngle(passed.corner + passed.edgeA + passed.edgeB, -passed.edgeA, -passed.edgeB);
        d.pdf = passed.weight / max(total * angle, TINY);
    }
    return d;
}

/// A direction drawn by a portal, or none: then u is for the sky's own density.
struct PortalSample {
    bool isAimed;
    uint portal;
    vec3 direction; ///< unit
};

const PortalSample NOT_AIMED = PortalSample(false, 0u, vec3(0.0, 0.0, 1.0));

PortalSample samplePortals(const Given given, vec3 p, vec3 n, inout vec2 u) {
    // By new digits where some are used up: the sky's own tables choose by all 24 of them.
    ChoiceNumber c = choiceNumber(u);
    const bool first = choosesFirst(c, uint(given.frame.portalShare * 2147483648.0));
    float within = restOf(c);
    const SeenPortal s = choosePortal(given.portals, p, n, within);
    PortalSample r = PortalSample(first && s.weight > 0.0, s.index, vec3(0.0, 0.0, 1.0));
    if (r.isAimed) {
        const vec3 normal = planeNormal(s.edgeA, s.edgeB), both = cross(s.edgeA, s.edgeB);
        const SolidAngleSample a = sampleQuadByAngle(s.corner, s.edgeA, s.edgeB, dot(s.corner, normal), dot(both, normal),
                                                     vec2(within, u.y));
        r.direction = unit(s.corner + a.weights.x * s.edgeA + a.weights.y * s.edgeB);
    } else if (s.weight > 0.0) {
        u.x = restOf(c);
    }
    return r;
}

/// The inverse of the density, by solid angle, of all samples to the sky in a direction. inverseOwnPdf: of those that do not
/// aim at portals; 0: there are none.
float skyInversePdf(const Frame frame, PortalDensity d, float inverseOwnPdf) {
    const float share = d.isAimed ? frame.portalShare : 0.0;
    const float ownPdf = inverseOwnPdf > 0.0 ? 1.0 / inverseOwnPdf : 0.0;
    return 1.0 / max(mix(ownPdf, d.pdf, share), TINY);
}

/// One whose light is looked up on arrival (skyFrom()): of radiance 1 and density 1.
LightSample skySampleOnArrival(PortalSample aimed, vec3 w) {
    return LightSample(w, true, w, vec3(1.0), 1.0, aimed.isAimed ? aimed.portal : NO_PORTAL);
}

/// A sample of the sky at a surface, in direction w. A direction that was drawn for one portal and belongs to another
/// brings nothing: then the densities are those of directions that belong to each.
LightSample skySample(const Given given, vec3 p, vec3 n, PortalSample aimed, vec3 w, vec3 radiance, float inverseOwnPdf) {
    float inversePdf = inverseOwnPdf;
    bool isOwn = true;
    if (PORTALS > 0u) {
        const PortalDensity d = portalDensity(given.portals, p, n, w);
        inversePdf = skyInversePdf(given.frame, d, inverseOwnPdf);
        isOwn = !aimed.isAimed || d.portal == aimed.portal;
    }
    return LightSample(w, true, w, isOwn ? radiance * inversePdf : vec3(0.0), inversePdf, NOT_SKY);
}

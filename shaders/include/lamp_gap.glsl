// Bounces into the gap between the scene's lamp and a surface close behind it (docs/estimator.md, "Gaps").
// That surface is bright, and is seen past the rims of the lamp only: in few directions, but from
// everywhere. One bounce in sixteen of diffuse surfaces goes there, by the one-sample balance heuristic
// (Veach and Guibas 1995), so that no weight is above 16 / 15.

const float GAP_SHARE = 0.0625; ///< of a surface's bounces

/// The lamp from the side that is not the gap's, from which the gap is looked into.
struct LampGap {
    vec3 corner;
    vec3 along0, along1; ///< unit vectors along the edges
    vec3 normal;         ///< unit, away from the gap
    vec2 size;           ///< of the lamp along the two
    float width;         ///< from the lamp to the surface; > 0
};
LampGap lampGap; ///< GUIDES: found once, as onlyLight is

void findLampGap() {
    const Light lamp = lightNumber(0u);
    const vec3 n = quadNormal(lamp);
    lampGap.corner = lamp.position;
    lampGap.along0 = unit(lamp.edgeA);
    lampGap.along1 = cross(n, lampGap.along0);
    lampGap.size = vec2(length(lamp.edgeA), dot(lamp.edgeB, lampGap.along1));
    lampGap.normal = frame.lampGap > 0.0 ? -n : n;
    lampGap.width = abs(frame.lampGap);
}

/// Whether bounces from s are mixed with those into the gap.
bool looksIntoGap(SurfacePoint s, Material m) {
    return GUIDES && isMaterial(m.kind, MATERIAL_DIFFUSE) &&
           dot(s.position - lampGap.corner, lampGap.normal) > 0.0;
}

/// The gap from a point on the lamp's other side, by points of the lamp's plane outside of a rim. Rims 0 and 1
/// are those at the low and high end along0, 2 and 3 along1. A rim's density at the distance s from it is
/// w / (w + s)^2: the lit surface is seen, past the rim, up to where the line of sight over the lamp's edge meets
/// it, d w0 / (v + w0) for the distances d and v of rim and plane and the gap's width w0; outside of the lamp
/// it stays bright for about w0.
struct GapView {
    vec2 foot;     ///< of the perpendicular on the plane, from the corner
    float height;  ///< above the plane
    vec4 width;    ///< w of each rim
    vec4 weight;   ///< times the rim's length: its share of the points, but for their sum
    float weights; ///< the sum
};

GapView viewGap(vec3 from) {
    GapView g;
    const vec3 d = from - lampGap.corner;
    g.foot = vec2(dot(d, lampGap.along0), dot(d, lampGap.along1));
    g.height = dot(d, lampGap.normal);
    const vec2 below = max(-g.foot, vec2(0.0)), above = max(g.foot - lampGap.size, vec2(0.0));
    const vec4 beside = vec4(below.x, above.x, below.y, above.y);
    g.width = lampGap.width + beside * (lampGap.width / (g.height + lampGap.width));
    g.weight = g.width * lampGap.size.yyxx;
    g.weights = (g.weight.x + g.weight.y) + (g.weight.z + g.weight.w);
    return g;
}

/// The point of the plane that u, in [0, 1)^2, stands for.
vec2 sampleRims(GapView g, vec2 u) {
    float x = u.x * g.weights;
    const bool first = x < g.weight.x + g.weight.y; // rims 0 and 1
    if (!first) x -= g.weight.x + g.weight.y;
    const vec2 weight = first ? g.weight.xy : g.weight.zw, width = first ? g.width.xy : g.width.zw;
    const bool high = x >= weight.x;
    const float along = high ? (x - weight.x) / weight.y : x / weight.x;
    const float beside = (high ? width.y : width.x) * (u.y / (1.0 - u.y));
    const vec2 size = first ? lampGap.size : lampGap.size.yx;
    const vec2 at = vec2(high ? size.x + beside : -beside, along * size.y);
    return first ? at : at.yx;
}

/// Density of bounces into the gap by solid angle, in the direction w (unit).
float gapPdf(GapView g, vec3 w) {
    const float cosine = -dot(w, lampGap.normal);
    const float t = g.height / cosine;
    if (!(cosine > 0.0 && t < INFINITE_DISTANCE)) return 0.0;
    const vec2 at = g.foot + t * vec2(dot(w, lampGap.along0), dot(w, lampGap.along1));
    const vec2 below = -at, above = at - lampGap.size, beside = max(below, above);
    const bool first = beside.x > 0.0; // beside rim 0 or 1
    if (first == (beside.y > 0.0)) return 0.0; // over the lamp, or beyond a corner
    const vec2 width = first ? g.width.xy : g.width.zw;
    const bool high = first ? above.x > below.x : above.y > below.y;
    const float rim = high ? width.y : width.x;
    // Per area w / (w + s)^2 times the rim's share w / weights; times t^2 / cosine.
    const float reach = t * (rim / (rim + (first ? beside.x : beside.y)));
    return (reach / g.weights) * reach / cosine;
}

/// Which numbers are left when u has decided whether to go into the gap: u.x < GAP_SHARE.
vec2 afterChoice(vec2 u) {
    return vec2(u.x < GAP_SHARE ? u.x / GAP_SHARE : (u.x - GAP_SHARE) / (1.0 - GAP_SHARE), u.y);
}

/// Turns the bounce b of a diffuse surface into one into the gap if `aims`; u: as afterChoice() left it.
/// Returns its weight beside b.weight, cos / pi over the density of both techniques; where no light is
/// reflected b.weight is 0.
float mixWithGap(inout BsdfSample b, Material m, SurfacePoint s, bool aims, vec2 u) {
    const GapView g = viewGap(s.position);
    if (aims) {
        const vec2 at = sampleRims(g, u) - g.foot;
        b.direction = unit(at.x * lampGap.along0 + at.y * lampGap.along1 - g.height * lampGap.normal);
        b.weight = isReflected(s, b.direction) ? m.reflectance : vec3(0.0);
    }
    const float pdf = max(dot(shadingNormal(s), b.direction), 0.0) * INV_PI;
    if (!(pdf > 0.0)) {
        b.weight = vec3(0.0);
        return 0.0;
    }
    return pdf / ((1.0 - GAP_SHARE) * pdf + GAP_SHARE * gapPdf(g, b.direction));
}

// The gap proposal: a second density from which bounces are drawn, besides the BSDF's own. It aims
// into the gap between the scene's only light, a rectangle, and a surface close behind it
// (docs/theory/estimator.md, "Gaps"). That surface is bright, and is seen past the rims of the light
// only: in few directions, but from everywhere. One bounce in sixteen from diffuse surfaces goes
// there, by the one-sample balance heuristic (Veach and Guibas 1995), so that no weight is above
// 16 / 15. host/kernel/gpu_scene.hpp finds the gap.

const float GAP_SHARE = 0.0625; ///< of a surface's bounces

Gap findGap(const Frame frame, const OnlyLight onlyLight) {
    Gap gap;
    if (!GAP_PROPOSAL) return gap;
    const QuadLight light = quadLight(onlyLight.rows);
    const vec3 n = onlyLight.normal;
    gap.corner = light.corner;
    gap.along0 = unit(light.edgeA);
    gap.along1 = cross(n, gap.along0);
    gap.size = vec2(length(light.edgeA), dot(light.edgeB, gap.along1));
    gap.normal = frame.gapWidth > 0.0 ? -n : n;
    gap.width = abs(frame.gapWidth);
    return gap;
}

/// Whether bounces from s are mixed with those into the gap.
bool looksIntoGap(const Gap gap, SurfacePoint s, uint lobes) {
    return GAP_PROPOSAL && lobes == LOBE_DIFFUSE_REFLECTION && dot(s.position - gap.corner, gap.normal) > 0.0;
}

/// The gap from a point on the light's other side, by points of the light's plane outside of a rim. Rims 0 and 1
/// are those at the low and high end along0, 2 and 3 along1. A rim's density at the distance s from it is
/// w / (w + s)^2: the lit surface is seen, past the rim, up to where the line of sight over the light's edge meets
/// it, d w0 / (v + w0) for the distances d and v of rim and plane and the gap's width w0; outside of the light
/// it stays bright for about w0.
struct GapView {
    vec2 foot;     ///< of the perpendicular on the plane, from the corner
    float height;  ///< above the plane
    vec4 width;    ///< w of each rim
    vec4 weight;   ///< times the rim's length: its share of the points, but for their sum
    float weights; ///< the sum
};

GapView viewGap(const Gap gap, vec3 from) {
    GapView g;
    const vec3 d = from - gap.corner;
    g.foot = vec2(dot(d, gap.along0), dot(d, gap.along1));
    g.height = dot(d, gap.normal);
    const vec2 below = max(-g.foot, vec2(0.0)), above = max(g.foot - gap.size, vec2(0.0));
    const vec4 beside = vec4(below.x, above.x, below.y, above.y);
    g.width = gap.width + beside * (gap.width / (g.height + gap.width));
    g.weight = g.width * gap.size.yyxx;
    g.weights = (g.weight.x + g.weight.y) + (g.weight.z + g.weight.w);
    return g;
}

/// The point of the plane that u, in [0, 1)^2, stands for.
vec2 sampleRims(const Gap gap, GapView g, vec2 u) {
    float x = u.x * g.weights;
    const bool first = x < g.weight.x + g.weight.y; // rims 0 and 1
    if (!first) x -= g.weight.x + g.weight.y;
    const vec2 weight = first ? g.weight.xy : g.weight.zw, width = first ? g.width.xy : g.width.zw;
    const bool high = x >= weight.x;
    const float along = high ? (x - weight.x) / weight.y : x / weight.x;
    const float beside = (high ? width.y : width.x) * (u.y / (1.0 - u.y));
    const vec2 size = first ? gap.size : gap.size.yx;
    const vec2 at = vec2(high ? size.x + beside : -beside, along * size.y);
    return first ? at : at.yx;
}

/// Density of bounces into the gap by solid angle, in the direction w (unit).
float gapPdf(const Gap gap, GapView g, vec3 w) {
    const float cosine = -dot(w, gap.normal);
    const float t = g.height / cosine;
    if (!(cosine > 0.0 && t < INFINITE_DISTANCE)) return 0.0;
    const vec2 at = g.foot + t * vec2(dot(w, gap.along0), dot(w, gap.along1));
    const vec2 below = -at, above = at - gap.size, beside = max(below, above);
    const bool first = beside.x > 0.0; // beside rim 0 or 1
    if (first == (beside.y > 0.0)) return 0.0; // over the light, or beyond a corner
    const vec2 width = first ? g.width.xy : g.width.zw;
    const bool high = first ? above.x > below.x : above.y > below.y;
    const float rim = high ? width.y : width.x;
    // Per area w / (w + s)^2 times the rim's share w / weights; times t^2 / cosine.
    const float reach = t * (rim / (rim + (first ? beside.x : beside.y)));
    return (reach / g.weights) * reach / cosine;
}

/// Density of bounces from s in the direction w, of which that by the BSDF alone is bsdfPdf.
float bouncePdfWithGap(const Gap gap, SurfacePoint s, uint lobes, float bsdfPdf, vec3 w) {
    if (!looksIntoGap(gap, s, lobes)) return bsdfPdf;
    return (1.0 - GAP_SHARE) * bsdfPdf + GAP_SHARE * gapPdf(gap, viewGap(gap, s.position), w);
}

/// Which numbers are left when u has decided whether to go into the gap: u.x < GAP_SHARE.
vec2 afterChoice(vec2 u) {
    return vec2(u.x < GAP_SHARE ? u.x / GAP_SHARE : (u.x - GAP_SHARE) / (1.0 - GAP_SHARE), u.y);
}

/// A direction from the BSDF or into the gap, with the density of the mixture of both. b.weight stays that
/// of the BSDF alone, f |cos| over its own density; mixtureWeight is that density over the mixture's, so
/// that a path's throughput is multiplied by both. They are apart because roulette goes by the first: a small
/// second one is no reason to end a path that goes where it is bright.
BsdfSample sampleBsdfOrGap(const Gap gap, Material m, SurfacePoint s, vec3 u, out float mixtureWeight) {
    const bool looks = looksIntoGap(gap, s, lobesOf(m)), aims = looks && u.x < GAP_SHARE;
    if (looks) u.xy = afterChoice(u.xy);
    BsdfSample b = sampleBsdf(m, s, u);
    mixtureWeight = 1.0;
    if (!looks) return b;
    const GapView g = viewGap(gap, s.position);
    if (aims) {
        const vec2 at = sampleRims(gap, g, u.xy) - g.foot;
        b.direction = unit(at.x * gap.along0 + at.y * gap.along1 - g.height * gap.normal);
        const BsdfValue f = evaluateBsdf(m, s, b.direction);
        b.weight = f.value / max(f.pdf, TINY);
        b.pdf = f.pdf;
    }
    const float mixture = (1.0 - GAP_SHARE) * b.pdf + GAP_SHARE * gapPdf(gap, g, b.direction);
    mixtureWeight = b.pdf / max(mixture, TINY);
    b.pdf = mixture;
    return b;
}

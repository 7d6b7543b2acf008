// Microfacets (Walter et al. 2007) of either distribution, GGX (Trowbridge and Reitz 1975) or Beckmann's, stretched
// along x and y, with Smith's masking and shadowing, height-correlated (Heitz 2014) or separable (Walter). Normals are
// sampled as they are seen from wo. Directions are unit vectors in the frame of the shading normal.
//
// Everything is in terms of the facets' projected area, |cos| (1 + Lambda): none of its parts is a difference
// of nearly equal numbers, and it is above 0 at grazing views, where Lambda has no bound.

/// The microfacets of a material.
struct FacetShape {
    vec2 alpha;
    bool isBeckmann, isSeparable;
};

const bool HAS_INTERFACES = (CLOSURES & CLOSURE_INTERFACE) != 0u;
const bool SOME_ARE_NOT_SMOOTH = (CLOSURES_OF_ALL & INTERFACE_IS_SMOOTH) == 0u;
const bool SOME_ARE_NOT_BECKMANN = (CLOSURES_OF_ALL & FACETS_ARE_BECKMANN) == 0u;
const bool SOME_ARE_BECKMANN = (CLOSURES & FACETS_ARE_BECKMANN) != 0u;
const bool HAS_FACETS = HAS_INTERFACES && SOME_ARE_NOT_SMOOTH;
const bool HAS_GGX = HAS_FACETS && SOME_ARE_NOT_BECKMANN;
const bool HAS_BECKMANN = HAS_FACETS && SOME_ARE_BECKMANN;

/// closures: the material's bits, which are looked at only where the scene has both of two.
FacetShape facetShape(vec2 alpha, uint closures) {
    return FacetShape(alpha, has(closures, FACETS_ARE_BECKMANN), has(closures, FACETS_ARE_SEPARABLE));
}

/// GGX's distribution per steradian; its integral times cos is 1.
float ggxD(vec3 h, vec2 alpha) {
    const vec2 slope = h.xy / alpha;
    const float q = dot(slope, slope) + h.z * h.z;
    return 1.0 / (PI * alpha.x * alpha.y * q * q);
}

float stretchedLength(vec3 w, vec2 alpha) { return length(vec3(alpha * w.xy, w.z)); }

/// The distribution of facets per steradian; its integral times cos is 1. Beckmann's takes the slope from x and y: 1 - z^2
/// has few correct digits near the normal. One expression for both, so that a kernel that has both computes what a kernel
/// of one does.
float facetD(FacetShape f, vec3 h) {
    const vec2 slope = h.xy / f.alpha;
    const float across2 = dot(slope, slope), cos2 = h.z * h.z; // the squared slope, over alpha, times cos2
    float q = across2 + cos2, shape = 1.0;
    if (HAS_BECKMANN && (!HAS_GGX || f.isBeckmann)) {
        q = cos2;
        shape = exp(-across2 / cos2);
    }
    return shape / (PI * f.alpha.x * f.alpha.y * q * q);
}

/// erf for x >= 0, absolute error below 1.5e-7 (Abramowitz and Stegun 7.1.26).
float erfPositive(float x) {
    const float t = 1.0 / (1.0 + 0.3275911 * x);
    const float p = t * (0.254829592 +
                         t * (-0.284496736 +
                              t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    return 1.0 - p * exp(-x * x);
}

/// Where a direction of Beckmann's facets of alpha 1 stands: its cosine over its sine. Beyond 10 all facets face it:
/// exp(-100) is below what floats hold.
float slopeLimit(float cosine, float sine) { return cosine / max(sine, 0.1 * cosine); }

/// tail: the weight of the last term of Lambda, which conventions differ in.
float facetArea(FacetShape f, vec3 w, float tail) {
    const float cosine = abs(w.z);
    float ggx = 0.0, beckmann = 0.0;
    if (HAS_GGX) ggx = 0.5 * (cosine + stretchedLength(w, f.alpha));
    if (HAS_BECKMANN) {
        const float sine = length(f.alpha * w.xy), limit = slopeLimit(cosine, sine);
        beckmann = 0.5 * cosine * (1.0 + erfPositive(limit)) + tail * sine * exp(-limit * limit);
    }
    return HAS_BECKMANN && (!HAS_GGX || f.isBeckmann) ? beckmann : ggx;
}

const float HALF_INVERSE_ROOT_PI = 0.282094791773878; // 1 / (2 sqrt(pi))

/// Projected area of the facets that are seen from w, over that of the surface they are on.
float facetArea(FacetShape f, vec3 w) { return facetArea(f, w, HALF_INVERSE_ROOT_PI); }

/// G2 / G1(wo), the share of the facets seen from wo that light from wi reaches. areaO: facetArea() of wo.
float facetsLit(FacetShape f, vec3 wo, float areaO, vec3 wi) {
    const float cosO = abs(wo.z), cosI = abs(wi.z), areaI = facetArea(f, wi, LAMBDA_TAIL);
    const float maskedO = EXACT_LAMBDA ? areaO : facetArea(f, wo, LAMBDA_TAIL);
    const float correlated = cosI * maskedO + cosO * (areaI - cosI), separable = areaI * maskedO;
    return cosI * areaO / (f.isSeparable ? separable : correlated);
}

/// Inverse of erf, |x| < 1: relative error below 4e-7 (Giles 2012, "Approximating the erfinv Function").
float erfInverse(float x) {
    const float w = -log((1.0 - x) * (1.0 + x)), a = w - 2.5, b = sqrt(max(w, 5.0)) - 3.0;
    const float middle =
        1.50140941 +
        a * (0.246640727 +
             a * (-0.00417768164 +
                  a * (-0.00125372503 +
                       a * (0.00021858087 +
                            a * (-4.39150654e-06 +
                                 a * (-3.5233877e-06 +
                                      a * (3.43273939e-07 + a * 2.81022636e-08)))))));
    const float tail =
        2.83297682 +
        b * (1.00167406 +
             b * (0.00943887047 +
                  b * (-0.0076224613 +
                       b * (0.00573950773 +
                            b * (-0.00367342844 +
                                 b * (0.00134934322 +
                                      b * (0.000100950558 + b * -0.000200214257)))))));
    return (w < 5.0 ? middle : tail) * x;
}

/// Slopes of Beckmann's facets of alpha 1 as they are seen from a direction of this cosine and sine, the first along
/// the view. The slope across is normal. That along the view, x, has the density (cos + x sin) exp(-x^2) where it is
/// positive, from -limit on. With t = |x| it is a sum of parts that can be inverted: below the limit 2 cos exp(-t^2)
/// for both signs, of which x > 0 has (cos + t sin) / (2 cos); beyond it cos exp(-t^2), and t sin exp(-t^2), which is
/// Rayleigh's. The number that chooses the sign is a hash of the others, which are used up.
vec2 visibleBeckmannSlopes(float cosine, float sine, vec2 u) {
    const float limit = slopeLimit(cosine, sine), below = erfPositive(limit);
    const vec3 parts = vec3(1.7724538509 * cosine * below,                // sqrt(pi)
                            0.88622692545 * cosine * (1.0 - below), // sqrt(pi) / 2
                            0.5 * sine * exp(-limit * limit));
    const float pick = u.x * (parts.x + parts.y + parts.z);
    const bool isBelow = pick < parts.x, isNormal = !isBelow && pick < parts.x + parts.y;
    const float from = isBelow ? 0.0 : (isNormal ? parts.x : parts.x + parts.y);
    const float rest =
        clamp((pick - from) / max(isBelow ? parts.x : (isNormal ? parts.y : parts.z), TINY), 0.0,
              1.0 - UNIT_ROUNDOFF);
    const float quantile = isBelow ? rest * below : below + rest * (1.0 - below);
    const float normal = erfInverse(min(quantile, 1.0 - UNIT_ROUNDOFF));
    const float rayleigh = sqrt(limit * limit - log(1.0 - rest));
    const float t = isBelow ? min(normal, limit) : max(isNormal ? normal : rayleigh, limit);
    const float sign_ = unitFloats(pcg4d(uvec4(floatBitsToUint(u), 1u, 0u))).x;
    const bool isNegative = isBelow && 2.0 * cosine * sign_ >= cosine + t * sine;
    const float across = erfInverse(clamp(2.0 * u.y - 1.0, UNIT_ROUNDOFF - 1.0, 1.0 - UNIT_ROUNDOFF));
    return vec2(isNegative ? -t : t, across);
}

/// A normal seen from wo (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023):
/// in the space where the surface is a hemisphere, mirrored directions are uniform on a cap.
vec3 sampleVisibleNormal(vec3 wo, vec2 alpha, vec2 u) {
    const vec3 v = unit(vec3(alpha * wo.xy, wo.z));
    const float cap = 1.0 + v.z, fromTop = u.x * cap; // 1 - z
    const float sine = sqrt(max(fromTop * (2.0 - fromTop), 0.0));
    const vec3 h = vec3(sine * cosSin(4.0 * u.y), 1.0 - fromTop) + v;
    return unit(vec3(alpha * h.xy, max(h.z, TINY)));
}

/// A normal seen from wo, wo.z > 0, with the density D(h) (wo . h) / facetArea(wo).
vec3 sampleFacet(FacetShape f, vec3 wo, vec2 u) {
    vec3 ggx, beckmann;
    if (HAS_GGX) ggx = sampleVisibleNormal(wo, f.alpha, u);
    if (!HAS_BECKMANN) return ggx;
    // In the space where the facets are of alpha 1, the view turned to the x axis.
    const vec3 v = unit(vec3(f.alpha * wo.xy, wo.z));
    const float sine = length(v.xy);
    const vec2 along = sine > 0.0 ? v.xy / sine : vec2(1.0, 0.0);
    const vec2 s = visibleBeckmannSlopes(v.z, sine, u);
    const vec2 slope = vec2(along.x * s.x - along.y * s.y, along.y * s.x + along.x * s.y);
    beckmann = unit(vec3(f.alpha * slope, 1.0));
    if (!HAS_GGX) return beckmann;
    return f.isBeckmann ? beckmann : ggx;
}

// A rough conductor: Beckmann microfacets (Cook and Torrance 1982, Walter et al. 2007), Smith's
// height-correlated masking, Fresnel's equations of a conductor.

/// Half vector of the Beckmann distribution, pdf D(h) cos(h) in solid angle; frame: normal +z.
vec3 sampleBeckmann(vec2 u, float alpha) {
    const float tan2 = -alpha * alpha * log(1.0 - u.x);
    const float cosine = inversesqrt(1.0 + tan2);
    const float sine = sqrt(tan2) * cosine;
    return vec3(sine * cosSin(4.0 * u.y), cosine);
}

/// Beckmann: D(h), per steradian; h.z > 0. The tangent comes from x and y: 1 - z^2 has few correct
/// digits near the normal, where all of D is for small alpha (1 % of D is lost at alpha 1e-3).
float beckmannD(vec3 h, float alpha) {
    const float cos2 = h.z * h.z;
    const float tan2 = dot(h.xy, h.xy) / cos2;
    return exp(-tan2 / (alpha * alpha)) / (PI * alpha * alpha * cos2 * cos2);
}

/// erf for x >= 0, absolute error below 1.5e-7 (Abramowitz and Stegun 7.1.26).
float erfPositive(float x) {
    const float t = 1.0 / (1.0 + 0.3275911 * x);
    const float p = t * (0.254829592 +
                         t * (-0.284496736 +
                              t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    return 1.0 - p * exp(-x * x);
}

/// Smith's Lambda for the Beckmann distribution.
float smithLambda(float cosine, float alpha) {
    const float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
    if (tangent == 0.0) return 0.0;
    const float a = 1.0 / (alpha * tangent);
    const float tail = exp(-a * a) / a;
    return 0.5 * (erfPositive(a) - 1.0) + lambdaTail(tail);
}

/// Exact unpolarised reflectance of a conductor, index eta + i k, at cosine of incidence
/// (Lagarde 2013, "Memo on Fresnel equations").
vec3 fresnelConductor(float cosine, vec3 eta, vec3 k) {
    const float cos2 = cosine * cosine, sin2 = 1.0 - cos2;
    const vec3 eta2 = eta * eta, k2 = k * k;
    const vec3 t0 = eta2 - k2 - sin2;
    const vec3 a2b2 = sqrt(t0 * t0 + 4.0 * eta2 * k2);
    const vec3 a = sqrt(max(0.5 * (a2b2 + t0), vec3(0.0)));
    const vec3 t1 = a2b2 + cos2, t2 = 2.0 * cosine * a;
    const vec3 rs = (t1 - t2) / (t1 + t2);
    const vec3 t3 = cos2 * a2b2 + sin2 * sin2, t4 = t2 * sin2;
    const vec3 rp = rs * (t3 - t4) / (t3 + t4);
    return 0.5 * (rs + rp);
}

vec3 reflectanceOf(RoughConductorParameters p, vec3 wi, vec3 h) {
    return EXACT_FRESNEL ? fresnelConductor(dot(wi, h), p.eta, p.k)
                         : fresnelConductorCs184(wi.z, p.eta, p.k);
}

/// Height-correlated masking and shadowing. At grazing angles it is as small as the cosine that the product
/// is divided by: it comes first in products, so that these do not overflow.
float smithG(float alpha, vec3 wo, vec3 wi) {
    return 1.0 / (1.0 + smithLambda(wo.z, alpha) + smithLambda(wi.z, alpha));
}

BsdfValue evaluateRoughConductor(RoughConductorParameters p, Incidence i, vec3 wi) {
    if (i.wo.z <= 0.0 || wi.z <= 0.0) return NO_SCATTERING;
    const vec3 h = unit(i.wo + wi);
    const float d = beckmannD(h, p.alpha);
    const float g = smithG(p.alpha, i.wo, wi);
    return BsdfValue(reflectanceOf(p, wi, h) * (g * d / (4.0 * i.wo.z)),
                     d * h.z / (4.0 * dot(i.wo, h)));
}

BsdfSample sampleRoughConductor(RoughConductorParameters p, Incidence i, vec3 u) {
    const vec3 h = sampleBeckmann(u.xy, p.alpha);
    const float cosine = dot(i.wo, h);
    const vec3 wi = 2.0 * cosine * h - i.wo;
    BsdfSample s = BsdfSample(wi, vec3(0.0), 0.0, LOBE_GLOSSY_REFLECTION);
    if (cosine <= 0.0 || wi.z <= 0.0 || i.wo.z <= 0.0) return s;
    // f cos / pdf with pdf = D(h) cos_h / (4 wo.h): D cancels.
    const float g = smithG(p.alpha, i.wo, wi);
    s.weight = reflectanceOf(p, wi, h) * (g * cosine / (i.wo.z * h.z));
    s.pdf = beckmannD(h, p.alpha) * h.z / (4.0 * cosine);
    return s;
}

// Materials: docs/estimator.md has the formulas, scene/model/material.hpp the parameters.

struct BsdfSample {
    vec3 direction; ///< unit, world
    vec3 weight;    ///< f |cos| / pdf; 0: the path ends
    bool transmitted;
};

bool isDelta(uint kind) {
    return isMaterial(kind, MATERIAL_MIRROR) ||
           isMaterial(kind, MATERIAL_REFRACTION) ||
           isMaterial(kind, MATERIAL_GLASS);
}

/// Two paths that come the same way may leave by different ones.
bool scattersAtRandom(uint kind) {
    return !isMaterial(kind, MATERIAL_MIRROR) &&
           !isMaterial(kind, MATERIAL_REFRACTION);
}

// --- Warps of [0,1)^2 ------------------------------------------------------------------------

/// Uniform on the unit disk. Polar map, area measure.
vec2 sampleDisk(vec2 u) {
    return sqrt(u.x) * cosSin(4.0 * u.y);
}

/// Hemisphere about +z, pdf cos / pi in solid angle (Malley's method).
vec3 sampleCosineHemisphere(vec2 u) {
    const vec2 d = sampleDisk(u);
    return vec3(d, sqrt(max(1.0 - u.x, 0.0)));
}

/// Hemisphere about +z, pdf 1 / (2 pi) in solid angle.
vec3 sampleUniformHemisphere(vec2 u) {
    return vec3(sqrt(max(1.0 - u.x * u.x, 0.0)) * cosSin(4.0 * u.y), u.x);
}

/// Half vector of the Beckmann distribution, pdf D(h) cos(h) in solid angle; frame: normal +z.
vec3 sampleBeckmann(vec2 u, float alpha) {
    const float tan2 = -alpha * alpha * log(1.0 - u.x);
    const float cosine = inversesqrt(1.0 + tan2);
    const float sine = sqrt(tan2) * cosine;
    return vec3(sine * cosSin(4.0 * u.y), cosine);
}

// --- Microfacets -----------------------------------------------------------------------------

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

/// Smith's Lambda for the Beckmann distribution. The CS184 renderer has pi where sqrt(pi) is due
/// and leaves the last term whole.
float smithLambda(float cosine, float alpha) {
    const float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
    if (tangent == 0.0) return 0.0;
    const float a = 1.0 / (alpha * tangent);
    const float tail = exp(-a * a) / a;
    if (CS184) return 0.5 * (erfPositive(a) - 1.0 + tail * INV_PI);
    return 0.5 * (erfPositive(a) - 1.0) + tail * 0.282094791773878; // 1 / (2 sqrt(pi))
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

/// The CS184 renderer's approximation, valid for k^2 >> 1.
vec3 fresnelConductorCs184(float c, vec3 eta, vec3 k) {
    const vec3 s = eta * eta + k * k, e = 2.0 * c * eta;
    const vec3 rs = (s - e + c * c) / (s + e + c * c);
    const vec3 rp = (s * c * c - e + 1.0) / (s * c * c + e + 1.0);
    return 0.5 * (rs + rp);
}

/// f of the conductor; wo, wi in the shading frame.
vec3 evaluateMicrofacet(Material m, vec3 wo, vec3 wi) {
    if (wo.z <= 0.0 || wi.z <= 0.0) return vec3(0.0);
    const float alpha = m.iorOrAlpha;
    const vec3 h = unit(wo + wi);
    const float g = 1.0 / (1.0 + smithLambda(wo.z, alpha) + smithLambda(wi.z, alpha));
    const vec3 f = CS184 ? fresnelConductorCs184(wi.z, m.transmittanceOrEta, m.k)
                         : fresnelConductor(dot(wi, h), m.transmittanceOrEta, m.k);
    return f * (g * beckmannD(h, alpha) / (4.0 * wo.z * wi.z));
}

/// Density (solid angle) of sampleMicrofacet, for directions that evaluateMicrofacet() is not 0 for.
float microfacetPdf(Material m, SurfacePoint s, vec3 wi) {
    const ShadingFrame frame_ = makeFrame(shadingNormal(s));
    const vec3 wo = toLocal(frame_, s.wo), h = unit(wo + toLocal(frame_, wi));
    return beckmannD(h, m.iorOrAlpha) * h.z / (4.0 * dot(wo, h));
}

BsdfSample sampleMicrofacet(Material m, ShadingFrame frame_, vec3 wo, vec2 u) {
    const vec3 h = sampleBeckmann(u, m.iorOrAlpha);
    const float cosine = dot(wo, h);
    const vec3 wi = 2.0 * cosine * h - wo;
    BsdfSample s = BsdfSample(toWorld(frame_, wi), vec3(0.0), false);
    if (cosine <= 0.0 || wi.z <= 0.0 || wo.z <= 0.0) return s;
    // f cos / pdf with pdf = D(h) cos_h / (4 wo.h): D cancels.
    const float g = 1.0 / (1.0 + smithLambda(wo.z, m.iorOrAlpha) +
                           smithLambda(wi.z, m.iorOrAlpha));
    const vec3 f = CS184 ? fresnelConductorCs184(wi.z, m.transmittanceOrEta, m.k)
                         : fresnelConductor(cosine, m.transmittanceOrEta, m.k);
    s.weight = f * (g * cosine / (wo.z * h.z));
    return s;
}

// --- Dielectrics -----------------------------------------------------------------------------

/// Unpolarised reflectance of a smooth interface. cosine: of incidence, > 0; eta: index on the
/// incident side over index on the other; cosTransmitted: out, 0 in total reflection.
float fresnelDielectric(float cosine, float eta, out float cosTransmitted) {
    const float sin2 = eta * eta * max(1.0 - cosine * cosine, 0.0);
    cosTransmitted = 0.0;
    if (sin2 >= 1.0) return 1.0;
    cosTransmitted = sqrt(1.0 - sin2);
    const float rs = (eta * cosine - cosTransmitted) / (eta * cosine + cosTransmitted);
    const float rp = (cosine - eta * cosTransmitted) / (cosine + eta * cosTransmitted);
    return 0.5 * (rs * rs + rp * rp);
}

/// Schlick's approximation as the CS184 renderer uses it.
float schlick(float cosine, float ior) {
    const float r = (1.0 - ior) / (1.0 + ior), r0 = r * r;
    const float c = 1.0 - cosine, c2 = c * c;
    return r0 + (1.0 - r0) * c2 * c2 * c;
}

/// Refraction and Glass: `reflects` says whether Fresnel reflection exists. n: unit normal on
/// the side of wo; entering: wo is outside.
BsdfSample sampleDielectric(Material m, vec3 n, vec3 wo, bool entering, bool reflects, float u) {
    const float eta = entering ? 1.0 / m.iorOrAlpha : m.iorOrAlpha;
    const float cosine = dot(n, wo);
    float cosTransmitted;
    const float exact = fresnelDielectric(cosine, eta, cosTransmitted);
    const bool total = cosTransmitted == 0.0;
    float reflectance = CS184 && !total ? schlick(cosine, m.iorOrAlpha) : exact;
    if (!reflects) reflectance = 0.0;
    BsdfSample s;
    if (u < reflectance) {
        s.direction = 2.0 * cosine * n - wo;
        s.weight = m.reflectance;
        s.transmitted = false;
    } else {
        s.direction = -eta * wo + (eta * cosine - cosTransmitted) * n;
        // Radiance is compressed by the square of the index ratio; that renderer divides by it.
        const float compression = CS184 ? 1.0 / (eta * eta) : eta * eta;
        s.weight = total ? vec3(0.0) : m.transmittanceOrEta * compression;
        s.transmitted = true;
    }
    return s;
}

// --- All materials -----------------------------------------------------------------------------

/// f(wo, wi) |cos(wi)| for world direction wi; 0 for delta materials.
vec3 evaluateBsdf(Material m, SurfacePoint s, vec3 wi) {
    const float cosine = dot(shadingNormal(s), wi);
    if (cosine <= 0.0 || (!CS184 && !isReflected(s, wi))) return vec3(0.0);
    vec3 f = vec3(0.0);
    if (isMaterial(m.kind, MATERIAL_DIFFUSE))
        f = m.reflectance * INV_PI;
    if (isMaterial(m.kind, MATERIAL_MICROFACET)) {
        const ShadingFrame frame_ = makeFrame(shadingNormal(s));
        f = evaluateMicrofacet(m, toLocal(frame_, s.wo), toLocal(frame_, wi));
    }
    return f * cosine;
}

/// Samples the next direction; u: for the direction, or x for the choice of one of two.
BsdfSample sampleBsdf(Material m, SurfacePoint s, vec2 u) {
    const vec3 normal = shadingNormal(s);
    const ShadingFrame frame_ = makeFrame(normal);
    BsdfSample b = BsdfSample(normal, vec3(0.0), false);
    if (isMaterial(m.kind, MATERIAL_DIFFUSE))
        b = BsdfSample(toWorld(frame_, sampleCosineHemisphere(u)), m.reflectance, false);
    if (isMaterial(m.kind, MATERIAL_MICROFACET))
        b = sampleMicrofacet(m, frame_, toLocal(frame_, s.wo), u);
    if (isMaterial(m.kind, MATERIAL_MIRROR))
        b = BsdfSample(2.0 * dot(normal, s.wo) * normal - s.wo, m.reflectance, false);
    const bool refracts = isMaterial(m.kind, MATERIAL_REFRACTION);
    const bool glass = isMaterial(m.kind, MATERIAL_GLASS);
    if (refracts || glass) {
        const bool entering = CS184 ? dot(normal, s.wo) >= 0.0 : s.outside;
        const vec3 n = dot(normal, s.wo) < 0.0 ? -normal : normal;
        b = sampleDielectric(m, n, s.wo, entering, glass, u.x);
    }
    // Deflections keep the length of wo but for rounding, which would add up over many.
    if (!isMaterial(m.kind, MATERIAL_DIFFUSE)) b.direction = unit(b.direction);
    // Light stays on the side of the true surface it was sent to.
    const bool rightSide = b.transmitted ? dot(s.geometric, b.direction) < 0.0
                                         : isReflected(s, b.direction);
    if (!CS184 && !rightSide) b.weight = vec3(0.0);
    return b;
}

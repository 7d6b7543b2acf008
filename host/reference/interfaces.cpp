#include "host/reference/interfaces.hpp"

#include "host/reference/arithmetic.hpp"
#include "host/reference/facets.hpp"
#include "host/reference/fresnel.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

glm::dvec3 mirrored(const glm::dvec3& wo, const glm::dvec3& h) {
    return 2 * glm::dot(wo, h) * h - wo;
}

/// Sets weight and density of a direction by what evaluation says of it.
BsdfSample weighed(BsdfSample s, const BsdfValue& f) {
    s.pdf = f.pdf;
    if (f.pdf > 0) s.weight = f.value / f.pdf;
    return s;
}

/// What one facet of a dielectric does, seen at a cosine > 0; transmitted radiance by the law of
/// the squared index. eta: index on the side of wo over that on the other.
struct DielectricFacet {
    glm::dvec3 reflected, transmitted;
    double reflects; ///< share of samples
    double cosTransmitted;

    DielectricFacet(const Material& m, double eta, double cosine) {
        const Interface face = dielectric(std::min(cosine, 1.0), eta);
        reflected = face.reflectance * glm::dvec3(m.reflectance);
        const glm::dvec3 through = (1 - face.reflectance) * glm::dvec3(m.transmittance);
        transmitted = eta * eta * through;
        reflects = shareOfReflection(reflected, through);
        cosTransmitted = face.cosTransmitted;
    }
};

} // namespace

double shareOfReflection(const glm::dvec3& reflected, const glm::dvec3& transmitted) {
    const double r = mean(reflected), t = mean(transmitted);
    return t > 0 ? r / (r + t) : 1;
}

BsdfSample sampleConductor(const Material& m, const glm::dvec3& wo,
                           const ShadingConventions& conventions) {
    const double cosine = std::clamp(std::abs(wo.z), 1e-300, 1.0);
    const glm::dvec3 fresnel = conventions.exactFresnel ? conductor(cosine, m.eta, m.k)
                                                        : approximateConductor(cosine, m.eta, m.k);
    return {
        {-wo.x, -wo.y, wo.z}, glm::dvec3(m.reflectance) * fresnel, 0, gpu::LOBE_DELTA_REFLECTION};
}

/// The sum over all orders: R + T^2 R (1 + R^2 + ...), T = 1 - R.
BsdfSample sampleThinDielectric(const Material& m, const glm::dvec3& wo, double u) {
    const double r = dielectric(std::min(std::abs(wo.z), 1.0), 1 / double(m.ior)).reflectance;
    const double all = r < 1 ? r + (1 - r) * (1 - r) * r / (1 - r * r) : 1;
    const glm::dvec3 reflected = all * glm::dvec3(m.reflectance);
    const glm::dvec3 transmitted = (1 - all) * glm::dvec3(m.transmittance);
    const double reflects = shareOfReflection(reflected, transmitted);
    if (u < reflects)
        return {{-wo.x, -wo.y, wo.z}, reflected / reflects, 0, gpu::LOBE_DELTA_REFLECTION};
    return {-wo, transmitted / (1 - reflects), 0, gpu::LOBE_DELTA_TRANSMISSION};
}

BsdfValue evaluateFacetConductor(const Material& m, const glm::dvec3& wo, const glm::dvec3& wi,
                                 const ShadingConventions& conventions) {
    if (!(wo.z > 0 && wi.z > 0)) return {};
    const FacetModel facets(m);
    const glm::dvec3 h = glm::normalize(wo + wi);
    const double cosine = std::min(glm::dot(wo, h), 1.0);
    const double lit = facets.visibleFromBoth(wo, wi, conventions.exactLambda);
    const glm::dvec3 fresnel = conventions.exactFresnel ? conductor(cosine, m.eta, m.k)
                                                        : approximateConductor(wi.z, m.eta, m.k);
    return {glm::dvec3(m.reflectance) * fresnel * (facets.density(h) * lit / (4 * wo.z)),
            facets.visibleDensity(wo, h) / (4 * cosine)};
}

BsdfSample sampleFacetConductor(const Material& m, const glm::dvec3& wo, const glm::dvec3& u,
                                const ShadingConventions& conventions) {
    BsdfSample s;
    s.lobe = gpu::LOBE_GLOSSY_REFLECTION;
    if (!(wo.z > 0)) return s;
    s.direction = mirrored(wo, FacetModel(m).sampleVisible(wo, u.x, u.y));
    return weighed(s, evaluateFacetConductor(m, wo, s.direction, conventions));
}

/// Walter et al. 2007, equations 20 and 21, and 16 for the half vector.
BsdfValue evaluateFacetDielectric(const Material& m, const glm::dvec3& wo, bool entering,
                                  const glm::dvec3& wi, const ShadingConventions& conventions) {
    if (!(wo.z > 0) || wi.z == 0) return {};
    const FacetModel facets(m);
    const double inside = m.ior, eta = entering ? 1 / inside : inside;
    glm::dvec3 h = wi.z > 0 ? wo + wi : -(eta * wo + wi);
    if (h.z < 0) h = -h;
    h = glm::normalize(h);
    const double cosO = glm::dot(wo, h), cosI = glm::dot(wi, h);
    if (!(cosO > 0)) return {};
    const DielectricFacet facet(m, eta, cosO);
    const double visible =
        facets.density(h) * facets.visibleFromBoth(wo, wi, conventions.exactLambda);
    const double pdfOfH = facets.visibleDensity(wo, h);
    if (wi.z > 0)
        return {facet.reflected * (visible / (4 * wo.z)), facet.reflects * pdfOfH / (4 * cosO)};
    if (!(cosI < 0)) return {};
    const double jacobian = -cosI / std::pow(eta * cosO + cosI, 2);
    return {facet.transmitted * (visible * cosO * jacobian / wo.z),
            (1 - facet.reflects) * pdfOfH * jacobian};
}

BsdfSample sampleFacetDielectric(const Material& m, const glm::dvec3& wo, bool entering,
                                 const glm::dvec3& u, const ShadingConventions& conventions) {
    BsdfSample s;
    s.lobe = gpu::LOBE_GLOSSY_REFLECTION;
    if (!(wo.z > 0)) return s;
    const glm::dvec3 h = FacetModel(m).sampleVisible(wo, u.x, u.y);
    const double inside = m.ior, eta = entering ? 1 / inside : inside, cosine = glm::dot(wo, h);
    const DielectricFacet facet(m, eta, cosine);
    s.direction = mirrored(wo, h);
    if (u.z >= facet.reflects) {
        s.lobe = gpu::LOBE_GLOSSY_TRANSMISSION;
        s.direction = (eta * cosine - facet.cosTransmitted) * h - eta * wo;
    }
    if (s.transmitted() != (s.direction.z < 0)) return s;
    return weighed(s, evaluateFacetDielectric(m, wo, entering, s.direction, conventions));
}

bool hasNarrowFacets(const Material& m) {
    const bool canHave = m.kind == MaterialKind::Conductor || m.kind == MaterialKind::Dielectric ||
                         m.kind == MaterialKind::Plastic;
    constexpr double kNarrow = 0.25; // that of the principled material's, squared
    const glm::vec2 alpha = m.facetAlpha();
    return canHave && !m.isSmooth() && std::min(alpha.x, alpha.y) < kNarrow;
}

} // namespace stromboli::reference

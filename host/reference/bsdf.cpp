#include "host/reference/bsdf.hpp"

#include "host/reference/burley.hpp"
#include "host/reference/interfaces.hpp"
#include "host/reference/medium.hpp"
#include "host/reference/microfacet.hpp"
#include "host/reference/principled.hpp"
#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

/// What a BSDF knows of how light arrives. wo: unit, in the frame of the shading normal; entering:
/// it comes from outside of what the surface bounds.
struct Incidence {
    glm::dvec3 wo;
    bool entering;
    const ShadingConventions& conventions;
    glm::dvec3 coat; ///< unit; the clear coat's normal
};

// Samples are in the frame of the shading normal, too.

BsdfSample reflect(const glm::dvec3& wo, const glm::dvec3& reflectance) {
    return {{-wo.x, -wo.y, wo.z}, reflectance, 0, gpu::LOBE_DELTA_REFLECTION};
}

/// Refraction to the far side. eta: index of the side of wo over that of the other.
BsdfSample refract(const glm::dvec3& wo, double eta, double cosTransmitted,
                   const glm::dvec3& weight) {
    const double z = wo.z >= 0 ? -cosTransmitted : cosTransmitted;
    return {{-eta * wo.x, -eta * wo.y, z}, weight, 0, gpu::LOBE_DELTA_TRANSMISSION};
}

// --- Diffuse -----------------------------------------------------------------------------------

BsdfValue evaluateDiffuse(const Material& m, const glm::dvec3& wi) {
    if (!(wi.z > 0)) return {};
    return {glm::dvec3(m.albedo) * (wi.z / kPi), wi.z / kPi};
}

BsdfSample sampleDiffuse(const Material& m, const glm::dvec3& u) {
    const glm::dvec3 wi = cosineHemisphere(u.x, u.y);
    return {wi, m.albedo, wi.z / kPi, gpu::LOBE_DIFFUSE_REFLECTION};
}

// --- Interfaces
// ------------------------------------------------------------------------------------

/// Refraction and glass. Radiance over the squared index is invariant: the path, traced against
/// the light, gains (index here / index beyond)^2, or by another convention the inverse.
BsdfSample sampleInterface(const Material& m, const Incidence& i, double u) {
    const double ior = m.ior, eta = i.entering ? 1 / ior : ior;
    const double cosine = std::min(std::abs(i.wo.z), 1.0);
    const Interface face = dielectric(cosine, eta);
    const double compression = i.conventions.compressesRadiance ? eta * eta : 1 / (eta * eta);
    const glm::dvec3 transmitted = glm::dvec3(m.transmittance) * compression;
    if (m.kind == MaterialKind::Refraction)
        return face.total ? BsdfSample{} : refract(i.wo, eta, face.cosTransmitted, transmitted);

    const bool exact = i.conventions.exactFresnel || face.total;
    const double share = exact ? face.reflectance : schlick(cosine, ior);
    const glm::dvec3 reflected = share * glm::dvec3(m.reflectance);
    const glm::dvec3 passed = (1 - share) * glm::dvec3(m.transmittance);
    const double reflects = shareOfReflection(reflected, passed);
    if (u < reflects) return reflect(i.wo, reflected / reflects);
    BsdfSample s = refract(i.wo, eta, face.cosTransmitted, passed * (compression / (1 - reflects)));
    s.chosen = 1 - reflects;
    return s;
}

// --- All kinds
// -------------------------------------------------------------------------------------

BsdfValue evaluateLocally(const Material& m, const Incidence& i, const glm::dvec3& wi) {
    switch (m.kind) {
    case MaterialKind::Diffuse:
        return evaluateDiffuse(m, wi);
    case MaterialKind::Principled:
        return m.isSmooth() ? BsdfValue{}
                            : evaluatePrincipled(m.principled, i.wo, i.entering, wi, i.coat);
    case MaterialKind::Conductor:
        return m.isSmooth() ? BsdfValue{} : evaluateFacetConductor(m, i.wo, wi, i.conventions);
    case MaterialKind::Dielectric:
        return m.isSmooth() ? BsdfValue{}
                            : evaluateFacetDielectric(m, i.wo, i.entering, wi, i.conventions);
    case MaterialKind::Plastic:
        return evaluatePlastic(m, i.wo, wi, i.conventions);
    case MaterialKind::Burley:
        return evaluateBurley(m.burley, i.wo, i.entering, wi);
    case MaterialKind::Mirror:
    case MaterialKind::Refraction:
    case MaterialKind::ThinDielectric:
        return {}; // delta lobes
    }
    return {};
}

BsdfSample sampleLocally(const Material& m, const Incidence& i, const glm::dvec3& u) {
    switch (m.kind) {
    case MaterialKind::Diffuse:
        return sampleDiffuse(m, u);
    case MaterialKind::Mirror:
        return reflect(i.wo, m.reflectance);
    case MaterialKind::Refraction:
        return sampleInterface(m, i, u.z);
    case MaterialKind::Principled:
        return m.isSmooth() ? sampleClearPrincipled(m.principled, i.wo, i.entering, u.z)
                            : samplePrincipled(m.principled, i.wo, i.entering, u, i.coat);
    case MaterialKind::Conductor:
        return m.isSmooth() ? sampleConductor(m, i.wo, i.conventions)
                            : sampleFacetConductor(m, i.wo, u, i.conventions);
    case MaterialKind::Dielectric:
        return m.isSmooth() ? sampleInterface(m, i, u.z)
                            : sampleFacetDielectric(m, i.wo, i.entering, u, i.conventions);
    case MaterialKind::ThinDielectric:
        return sampleThinDielectric(m, i.wo, u.z);
    case MaterialKind::Plastic:
        return samplePlastic(m, i.wo, u, i.conventions);
    case MaterialKind::Burley:
        return sampleBurley(m.burley, i.wo, i.entering, u);
    }
    return {};
}

Incidence incidenceOn(const SurfacePoint& s, const Frame& frame,
                      const ShadingConventions& conventions) {
    const glm::dvec3 wo = frame.toLocal(s.wo);
    const glm::dvec3 coat = s.coat ? frame.toLocal(*s.coat) : glm::dvec3(0, 0, 1);
    return {wo, conventions.facesForward ? s.outside : wo.z >= 0, conventions, coat};
}

/// Light stays on the side of the true surface that its lobe sends it to.
bool isOnItsSide(const SurfacePoint& s, const glm::dvec3& wi, bool transmitted,
                 const ShadingConventions& conventions) {
    if (!conventions.testsGeometricSide) return true;
    return transmitted ? glm::dot(s.geometric, wi) < 0 : isReflected(s, wi);
}

/// What is left of light from wi after the bumps of a surface, each as a wall of microfacets (Conty
/// Estevez, Lecocq and Stein 2019); none that comes from below one horizon and above the other.
double reliefShadow(const SurfacePoint& s, const glm::dvec3& wi) {
    if (!s.material->hasReliefRules()) return 1;
    const double cosine = glm::dot(s.unmapped, wi);
    if (cosine * glm::dot(s.shading, wi) <= 0) return 0;
    if (!s.material->reliefShadows) return 1;
    const auto squaredTangent = [](double c) { return std::max(1 / (c * c) - 1, 0.0); };
    const double tilt = glm::dot(s.unmapped, s.shading);
    const double alpha2 = std::min(squaredTangent(tilt) / 8, 1.0);
    if (alpha2 == 0) return 1;
    return 2 / (1 + std::sqrt(1 + alpha2 * squaredTangent(cosine)));
}

/// The materials of a surface of which `which` is true, together, each by its share.
template <class Which>
BsdfValue evaluateThose(const SurfacePoint& s, const glm::dvec3& wi,
                        const ShadingConventions& conventions, const Which& which) {
    const Frame frame = surfaceFrame(s);
    const glm::dvec3 local = frame.toLocal(wi);
    if (!isOnItsSide(s, wi, local.z < 0, conventions)) return {};
    BsdfValue sum;
    const auto add = [&](const Material& m, double share) {
        if (!which(m)) return;
        const BsdfValue f = evaluateLocally(m, incidenceOn(s, frame, conventions), local);
        sum.value += share * f.value;
        sum.pdf += share * f.pdf;
    };
    add(*s.material, s.share);
    for (const SurfacePoint::Part& part : s.others)
        add(*part.material, part.share);
    sum.value *= reliefShadow(s, wi);
    return sum;
}

/// Under surfaces, where no light samples are taken, light comes by bounces alone, as to delta
/// lobes.
uint32_t phaseLobe(const Medium& m) {
    return m.isUnderSurface ? gpu::LOBE_DELTA_REFLECTION : gpu::LOBE_DIFFUSE_REFLECTION;
}

BsdfValue evaluatePhase(const SurfacePoint& s, const glm::dvec3& wi) {
    const double density = phaseDensity(*s.medium, -glm::dot(s.wo, wi));
    return {glm::dvec3(density), density};
}

/// Without what light samples leave to bounces.
BsdfValue evaluateWidePhase(const SurfacePoint& s, const glm::dvec3& wi) {
    BsdfValue f = evaluatePhase(s, wi);
    f.value -= narrowPhaseDensity(*s.medium, -glm::dot(s.wo, wi));
    f.value = glm::max(f.value, 0.0);
    return f;
}

/// The share of the light from there that light samples leave to bounces.
glm::dvec3 shareLeft(const SurfacePoint& s, const glm::dvec3& wi,
                     const ShadingConventions& conventions) {
    if (s.others.empty()) return glm::dvec3(leavesLightsToBounces(*s.material) ? 1.0 : 0.0);
    const glm::dvec3 all = evaluateBsdf(s, wi, conventions).value;
    const glm::dvec3 taken = evaluateForLights(s, wi, conventions).value;
    glm::dvec3 left(0.0);
    for (int c = 0; c < 3; ++c)
        if (all[c] > 0) left[c] = 1 - taken[c] / all[c];
    return left;
}

/// A sample of the drawn material, as one of all that scatter with it.
BsdfSample ofMixture(BsdfSample sample, const SurfacePoint& s,
                     const ShadingConventions& conventions) {
    const Frame frame = surfaceFrame(s);
    const glm::dvec3 local = frame.toLocal(sample.direction);
    const BsdfValue own = evaluateLocally(*s.material, incidenceOn(s, frame, conventions), local);
    // What falls on the wrong side is lost, and no density counts it.
    const bool isLost = sample.transmitted() != (local.z < 0) || !(own.pdf > 0);
    const BsdfValue all = evaluateBsdf(s, sample.direction, conventions);
    sample.pdf = all.pdf;
    sample.weight = isLost || !(all.pdf > 0) ? glm::dvec3(0.0) : all.value / all.pdf;
    sample.left = shareLeft(s, sample.direction, conventions);
    return sample;
}

/// Whether some lobe is too narrow for light samples to find: their noise would have no bound that
/// samples reach.
bool isNarrow(const PrincipledParameters& p) {
    constexpr double kNarrow = 0.5; // glTF's roughness: facets within 14 degrees
    return p.roughness < kNarrow || (p.clearcoat > 0 && p.clearcoatRoughness < kNarrow);
}

} // namespace

Frame surfaceFrame(const SurfacePoint& s) {
    if (s.tangent.w != 0) {
        const glm::dvec3 x(s.tangent);
        return {x, s.tangent.w * glm::cross(s.shading, x), s.shading};
    }
    Frame frame(s.shading);
    const auto hasGrain = [](const SurfacePoint::Part& p) { return p.material->hasGrain(); };
    if (!s.material->hasGrain() && std::ranges::none_of(s.others, hasGrain)) return frame;
    // What has a grain needs a tangent that the kernel has too (Duff et al. 2017).
    const glm::dvec3& n = s.shading;
    const double sign = n.z >= 0 ? 1 : -1, a = -1 / (sign + n.z);
    frame.x = {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
    frame.y = glm::cross(n, frame.x);
    return frame;
}

bool isLitFromBehind(const Material& material) {
    return (lobesOf(material) & gpu::TRANSMISSION_LOBES & ~gpu::DELTA_LOBES) != 0;
}

bool isLitFromBehind(const SurfacePoint& s) {
    return (lobesOf(s) & gpu::TRANSMISSION_LOBES & ~gpu::DELTA_LOBES) != 0;
}

bool leavesLightsToBounces(const SurfacePoint& s) {
    if (s.medium) return isNarrow(*s.medium);
    return leavesLightsToBounces(*s.material) &&
           std::ranges::all_of(s.others, [](const SurfacePoint::Part& p) {
               return leavesLightsToBounces(*p.material);
           });
}

bool leavesLightsToBounces(const Material& material) {
    return (material.kind == MaterialKind::Principled && isNarrow(material.principled)) ||
           (material.kind == MaterialKind::Burley && isNarrow(material.burley)) ||
           hasNarrowFacets(material);
}

bool boundsVolume(const Material& material) {
    return material.kind == MaterialKind::Principled && !material.principled.isThin;
}

glm::dvec3 absorptionInside(const Material& material) {
    return absorption(material.principled);
}

uint32_t lobesOf(const Material& material) {
    const bool isSmooth = material.isSmooth();
    switch (material.kind) {
    case MaterialKind::Diffuse:
        return gpu::LOBE_DIFFUSE_REFLECTION;
    case MaterialKind::Mirror:
        return gpu::LOBE_DELTA_REFLECTION;
    case MaterialKind::Refraction:
        return gpu::LOBE_DELTA_TRANSMISSION;
    case MaterialKind::Principled:
        return isSmooth ? gpu::LOBE_DELTA_REFLECTION | gpu::LOBE_DELTA_TRANSMISSION
                        : principledLobes(material.principled);
    case MaterialKind::Conductor:
        return isSmooth ? gpu::LOBE_DELTA_REFLECTION : gpu::LOBE_GLOSSY_REFLECTION;
    case MaterialKind::Dielectric:
        return isSmooth ? gpu::LOBE_DELTA_REFLECTION | gpu::LOBE_DELTA_TRANSMISSION
                        : gpu::LOBE_GLOSSY_REFLECTION | gpu::LOBE_GLOSSY_TRANSMISSION;
    case MaterialKind::ThinDielectric:
        return gpu::LOBE_DELTA_REFLECTION | gpu::LOBE_DELTA_TRANSMISSION;
    case MaterialKind::Plastic: // with facets the base's samples have the density of the mixture
        return isSmooth ? gpu::LOBE_DELTA_REFLECTION | gpu::LOBE_DIFFUSE_REFLECTION
                        : gpu::LOBE_GLOSSY_REFLECTION;
    case MaterialKind::Burley:
        return burleyLobes(material.burley);
    }
    return 0;
}

uint32_t lobesOf(const SurfacePoint& s) {
    if (s.medium) return phaseLobe(*s.medium);
    uint32_t lobes = lobesOf(*s.material);
    for (const SurfacePoint::Part& part : s.others)
        lobes |= lobesOf(*part.material);
    return lobes;
}

bool scattersIntoManyDirections(uint32_t lobes) {
    return (lobes & ~gpu::DELTA_LOBES) != 0;
}

bool scattersAtRandom(uint32_t lobes) {
    return lobes != gpu::LOBE_DELTA_REFLECTION && lobes != gpu::LOBE_DELTA_TRANSMISSION;
}

BsdfValue evaluateBsdf(const SurfacePoint& s, const glm::dvec3& wi,
                       const ShadingConventions& conventions) {
    if (s.medium) return evaluatePhase(s, wi);
    return evaluateThose(s, wi, conventions, [](const Material&) { return true; });
}

BsdfValue evaluateForLights(const SurfacePoint& s, const glm::dvec3& wi,
                            const ShadingConventions& conventions) {
    if (s.medium) return isNarrow(*s.medium) ? BsdfValue{} : evaluateWidePhase(s, wi);
    return evaluateThose(s, wi, conventions,
                         [](const Material& m) { return !leavesLightsToBounces(m); });
}

BsdfSample sampleBsdf(const SurfacePoint& s, const glm::dvec3& u,
                      const ShadingConventions& conventions) {
    if (s.medium) {
        const glm::dvec3 wi = samplePhase(*s.medium, -s.wo, u.x, u.y);
        const double density = evaluatePhase(s, wi).pdf;
        const double narrow = narrowPhaseDensity(*s.medium, -glm::dot(s.wo, wi));
        return {wi, glm::dvec3(1.0), density, phaseLobe(*s.medium),
                glm::dvec3(isNarrow(*s.medium) ? 1.0 : narrow / density)};
    }
    const Frame frame = surfaceFrame(s);
    BsdfSample sample = sampleLocally(*s.material, incidenceOn(s, frame, conventions), u);
    // Rounding errors of the direction's length would add up along a path.
    sample.direction = glm::normalize(frame.toWorld(sample.direction));
    // The share of a delta lobe is that of the draw.
    if (!s.others.empty() && !sample.isDelta()) return ofMixture(sample, s, conventions);
    if (!isOnItsSide(s, sample.direction, sample.transmitted(), conventions))
        sample.weight = glm::dvec3(0.0);
    sample.weight *= reliefShadow(s, sample.direction);
    if (!sample.isDelta()) sample.left = shareLeft(s, sample.direction, conventions);
    return sample;
}

} // namespace stromboli::reference

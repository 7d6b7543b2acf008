#include "host/reference/bsdf.hpp"

#include "host/reference/fresnel.hpp"
#include "host/reference/microfacet.hpp"
#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

/// A sample in the frame of the shading normal.
struct LocalSample {
    glm::dvec3 direction{0, 0, 1};
    glm::dvec3 weight{0.0};
    bool transmitted = false;
};

LocalSample reflect(const glm::dvec3& wo, const glm::dvec3& reflectance) {
    return {{-wo.x, -wo.y, wo.z}, reflectance, false};
}

/// Refraction to the far side. eta: index of the side of wo over that of the other.
LocalSample refract(const glm::dvec3& wo, double eta, double cosTransmitted,
                    const glm::dvec3& weight) {
    const double z = wo.z >= 0 ? -cosTransmitted : cosTransmitted;
    return {{-eta * wo.x, -eta * wo.y, z}, weight, true};
}

LocalSample sampleDiffuse(const Material& m, RandomStream& random) {
    const double u = random.next(), v = random.next();
    return {cosineHemisphere(u, v), m.albedo, false};
}

LocalSample sampleMicrofacet(const Material& m, const glm::dvec3& wo, RandomStream& random,
                             Convention convention) {
    const double u = random.next(), v = random.next();
    const glm::dvec3 h = sampleBeckmann(m.alpha, u, v);
    const glm::dvec3 wi = 2 * glm::dot(wo, h) * h - wo;
    if (!(wo.z > 0 && wi.z > 0)) return {};
    const double density = microfacetDensity(m.alpha, wo, wi);
    // So far down the tail of D that it has no double.
    if (!(density > 0)) return {};
    return {wi, microfacet(m, wo, wi, convention) * (wi.z / density), false};
}

/// Refraction and Glass. Radiance over the squared index is invariant: the path, traced against
/// the light, gains (index here / index beyond)^2; the CS184 renderer has the inverse.
LocalSample sampleInterface(const Material& m, const glm::dvec3& wo, bool entering,
                            RandomStream& random, Convention convention) {
    const bool physical = convention == Convention::Physical;
    const double ior = m.ior, eta = entering ? 1 / ior : ior;
    const double cosine = std::min(std::abs(wo.z), 1.0);
    const Interface face = dielectric(cosine, eta);
    const glm::dvec3 transmitted =
        glm::dvec3(m.transmittance) * (physical ? eta * eta : 1 / (eta * eta));
    if (m.kind == MaterialKind::Refraction)
        return face.total ? LocalSample{} : refract(wo, eta, face.cosTransmitted, transmitted);

    const double reflectance = physical || face.total ? face.reflectance : schlick(cosine, ior);
    if (random.next() < reflectance) return reflect(wo, m.reflectance);
    return refract(wo, eta, face.cosTransmitted, transmitted);
}

LocalSample sampleLocal(const SurfacePoint& s, const glm::dvec3& wo, RandomStream& random,
                        Convention convention) {
    const Material& m = *s.material;
    const bool entering = convention == Convention::Physical ? s.outside : wo.z >= 0;
    switch (m.kind) {
    case MaterialKind::Diffuse:
        return sampleDiffuse(m, random);
    case MaterialKind::Mirror:
        return reflect(wo, m.reflectance);
    case MaterialKind::Refraction:
    case MaterialKind::Glass:
        return sampleInterface(m, wo, entering, random, convention);
    case MaterialKind::Microfacet:
        return sampleMicrofacet(m, wo, random, convention);
    }
    return {};
}

} // namespace

glm::dvec3 evaluateBsdf(const SurfacePoint& s, const glm::dvec3& wi, Convention convention) {
    const Material& m = *s.material;
    const double cosine = glm::dot(s.shading, wi);
    if (m.isDelta() || !(cosine > 0)) return glm::dvec3(0.0);
    if (convention == Convention::Physical && !isReflected(s, wi)) return glm::dvec3(0.0);
    if (m.kind == MaterialKind::Diffuse) return glm::dvec3(m.albedo) * (cosine / kPi);
    const Frame frame(s.shading);
    return microfacet(m, frame.toLocal(s.wo), frame.toLocal(wi), convention) * cosine;
}

BsdfSample sampleBsdf(const SurfacePoint& s, RandomStream& random, Convention convention) {
    random.beginBlock();
    const Frame frame(s.shading);
    const LocalSample local = sampleLocal(s, frame.toLocal(s.wo), random, convention);
    // Rounding errors of the direction's length would add up along a path.
    BsdfSample sample{glm::normalize(frame.toWorld(local.direction)), local.weight,
                      local.transmitted};
    const bool rightSide = local.transmitted ? glm::dot(s.geometric, sample.direction) < 0
                                             : isReflected(s, sample.direction);
    if (convention == Convention::Physical && !rightSide) sample.weight = glm::dvec3(0.0);
    return sample;
}

} // namespace stromboli::reference

#include "host/reference/interfaces.hpp"

#include "host/reference/microfacet.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

namespace stromboli::reference {

// --- Conductors and dielectrics ------------------------------------------------------------------

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
    return {
        -wo,         transmitted / (1 - reflects), 0, gpu::LOBE_DELTA_TRANSMISSION, glm::dvec3(1.0),
        1 - reflects};
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

// --- Plastic -------------------------------------------------------------------------------------

namespace {

/// What an interface does with light that it scatters once.
class PlasticInterface {
  public:
    explicit PlasticInterface(const Material& m);

    /// The share of light from above that it lets through.
    double transmittance(double cosine) const;
    /// Share of diffuse light from below that it sends back.
    double internal() const { return internal_; }

  private:
    static constexpr int kKnots = 256;
    double eta_; ///< index above over index below
    bool smooth_;
    double internal_ = 0;
    std::vector<double> table_; ///< by the root of the cosine
};

struct ScatteredOnce {
    double reflected = 0, transmitted = 0;
};

/// By an integral over the tangent of the facets' normals, t = alpha tan(a), a in [0, pi / 2).
ScatteredOnce scatteredBy(const FacetModel& facets, double eta, double cosine, int rings) {
    constexpr int kSectors = 48;
    const double alpha = facets.alphaX;
    const glm::dvec3 wo(std::sqrt(std::max(1 - cosine * cosine, 0.0)), 0, cosine);
    ScatteredOnce sum;
    for (int i = 0; i < rings; ++i) {
        const double a = kPi / 2 * (i + 0.5) / rings, t = alpha * std::tan(a);
        const double z = 1 / std::sqrt(1 + t * t);
        // sin dtheta = t z^3 dt, dt = alpha / cos^2 a da
        const double ring = t * z * z * z * alpha / std::pow(std::cos(a), 2) * (kPi / 2 / rings);
        for (int j = 0; j < kSectors; ++j) {
            const double phi = kPi * (j + 0.5) / kSectors; // the other half is the same
            const glm::dvec3 h(t * z * std::cos(phi), t * z * std::sin(phi), z);
            const double cosO = glm::dot(wo, h);
            if (cosO <= 0) continue;
            const double seen = facets.visibleDensity(wo, h) * ring * 2 * kPi / kSectors;
            const Interface face = dielectric(std::min(cosO, 1.0), eta);
            const double g1 = 1 / (1 + facets.lambda(wo));
            const glm::dvec3 reflected = 2 * cosO * h - wo;
            if (reflected.z > 0)
                sum.reflected +=
                    seen * face.reflectance * facets.visibleFromBoth(wo, reflected) / g1;
            const glm::dvec3 refracted = (eta * cosO - face.cosTransmitted) * h - eta * wo;
            if (!face.total && refracted.z < 0)
                sum.transmitted +=
                    seen * (1 - face.reflectance) * facets.visibleFromBoth(wo, refracted) / g1;
        }
    }
    return sum;
}

PlasticInterface::PlasticInterface(const Material& m)
    : eta_(1 / double(m.ior)), smooth_(m.isSmooth()) {
    const FacetModel facets(m);
    // Diffuse light has the density 2 mu by the cosine. Total reflection ends with a root.
    const int views = smooth_ ? 200000 : 300;
    for (int i = 0; i < views; ++i) {
        const double mu = (i + 0.5) / views;
        const double back = smooth_ ? dielectric(mu, m.ior).reflectance
                                    : scatteredBy(facets, m.ior, mu, 64).reflected;
        internal_ += 2 * mu * back / views;
    }
    if (smooth_) return;
    if (const uint32_t few = m.internalViews; few > 1) {
        internal_ = 0;
        for (uint32_t i = 0; i < few; ++i) {
            const double mu = std::max(double(i) / (few - 1), 1e-6);
            internal_ += 2 * mu * scatteredBy(facets, m.ior, mu, 64).reflected / few;
        }
    }
    for (int i = 0; i <= kKnots; ++i) {
        const double root = std::max(double(i) / kKnots, 1e-5);
        table_.push_back(scatteredBy(facets, eta_, root * root, 256).transmitted);
    }
}

double PlasticInterface::transmittance(double cosine) const {
    const double mu = std::clamp(cosine, 0.0, 1.0);
    if (smooth_) return 1 - dielectric(mu, eta_).reflectance;
    const double place = std::sqrt(mu) * kKnots;
    const auto knot = std::min(size_t(place), size_t(kKnots - 1));
    const double x = place - double(knot);
    return (1 - x) * table_[knot] + x * table_[knot + 1];
}

/// Made once for all materials that have the same.
const PlasticInterface& interfaceOf(const Material& m) {
    using Key = std::tuple<float, float, FacetDistribution, FacetMasking, uint32_t>;
    static std::mutex mutex;
    static std::map<Key, std::unique_ptr<PlasticInterface>> known;
    const float alpha = m.isSmooth() ? 0 : m.facetAlpha().x;
    const std::lock_guard lock(mutex);
    auto& own = known[{m.ior, alpha, m.facets.distribution, m.facets.masking, m.internalViews}];
    if (!own) own = std::make_unique<PlasticInterface>(m);
    return *own;
}

/// The material as it is seen from wo.
struct SeenPlastic {
    const Material& m;
    const glm::dvec3& wo;
    const PlasticInterface& interface;
    bool exactLambda;
    double through, topShare;

    SeenPlastic(const Material& material, const glm::dvec3& from,
                const ShadingConventions& conventions)
        : m(material), wo(from), interface(interfaceOf(material)),
          exactLambda(conventions.exactLambda), through(interface.transmittance(wo.z)) {
        const double top = (1 - through) * mean(m.reflectance);
        topShare = top > 0 ? top / (top + through * mean(m.albedo)) : 0;
    }

    /// The BSDF of the base: what comes through the interface, times the sum over all reflections
    /// between base and interface.
    BsdfValue base(const glm::dvec3& wi) const {
        const glm::dvec3 albedo(m.albedo), back = (m.isNonlinear ? albedo : glm::dvec3(1.0));
        const double n2 = double(m.ior) * m.ior;
        const double both = through * interface.transmittance(wi.z);
        return {albedo / (1.0 - back * interface.internal()) * (both * wi.z / (kPi * n2)),
                (1 - topShare) * wi.z / kPi};
    }

    BsdfValue evaluate(const glm::dvec3& wi) const {
        if (!(wo.z > 0 && wi.z > 0)) return {};
        BsdfValue f = base(wi);
        if (m.isSmooth()) return f;
        const FacetModel facets(m);
        const glm::dvec3 h = glm::normalize(wo + wi);
        const double cosine = std::min(glm::dot(wo, h), 1.0);
        const double fresnel = dielectric(cosine, 1 / double(m.ior)).reflectance;
        f.value +=
            glm::dvec3(m.reflectance) * (fresnel * facets.density(h) *
                                         facets.visibleFromBoth(wo, wi, exactLambda) / (4 * wo.z));
        f.pdf += topShare * facets.visibleDensity(wo, h) / (4 * cosine);
        return f;
    }
};

} // namespace

BsdfValue evaluatePlastic(const Material& m, const glm::dvec3& wo, const glm::dvec3& wi,
                          const ShadingConventions& conventions) {
    if (!(wo.z > 0)) return {};
    return SeenPlastic(m, wo, conventions).evaluate(wi);
}

BsdfSample samplePlastic(const Material& m, const glm::dvec3& wo, const glm::dvec3& u,
                         const ShadingConventions& conventions) {
    BsdfSample s;
    s.lobe = m.isSmooth() ? gpu::LOBE_DIFFUSE_REFLECTION : gpu::LOBE_GLOSSY_REFLECTION;
    if (!(wo.z > 0)) return s;
    const SeenPlastic seen(m, wo, conventions);
    const bool isTop = u.z < seen.topShare;
    if (isTop && m.isSmooth())
        return {{-wo.x, -wo.y, wo.z},
                glm::dvec3(m.reflectance) * ((1 - seen.through) / seen.topShare),
                0,
                gpu::LOBE_DELTA_REFLECTION};
    if (isTop) {
        const glm::dvec3 h = FacetModel(m).sampleVisible(wo, u.x, u.y);
        s.direction = 2 * glm::dot(wo, h) * h - wo;
    } else {
        s.direction = cosineHemisphere(u.x, u.y);
    }
    const BsdfValue f = seen.evaluate(s.direction);
    s.pdf = f.pdf;
    if (f.pdf > 0) s.weight = f.value / f.pdf;
    return s;
}

} // namespace stromboli::reference

#include "host/reference/principled.hpp"

#include "host/reference/microfacet.hpp"
#include "host/reference/sampling.hpp"
#include "host/reference/sheen.hpp"
#include "host/reference/thin_film.hpp"
#include "shaders/shared/albedo_fits.h"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

using glm::dvec3;

double largestComponent(const dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

bool transmits(const PrincipledParameters& p) {
    return p.transmission > 0 && p.metallic < 1;
}

bool refracts(const PrincipledParameters& p) {
    return transmits(p) && !p.isThin;
}

/// Index inside over index outside. glTF writes 0 for an index without bounds; light is not
/// refracted between equal indices.
double usedIndex(const PrincipledParameters& p) {
    if (p.ior == 0) return 1e6;
    const double step = double(p.ior) - 1, least = gpu::LEAST_INDEX_STEP;
    if (!refracts(p) || std::abs(step) >= least) return p.ior;
    return step < 0 ? 1 - least : 1 + least;
}

/// Indices of red, green and blue light. The middle one is that of the material; the Abbe number is
/// it less 1 over the difference of the outer ones.
dvec3 indicesOf(const PrincipledParameters& p) {
    const double middle = usedIndex(p);
    if (!refracts(p) || p.dispersion <= 0 || middle <= 1 || p.ior == 0) return dvec3(middle);
    const double abbe = 20 / double(p.dispersion), outer = (double(p.ior) - 1) / abbe;
    if (!(outer > 0)) return dvec3(middle);
    const double least = 1 + double(gpu::LEAST_INDEX_STEP);
    return glm::max(dvec3(middle - outer / 2, middle, middle + outer / 2), dvec3(least));
}

dvec3 mixed(const dvec3& f0, double f90, double weight) {
    return f0 * (1 - weight) + f90 * weight;
}

double schlickWeight(double cosine) {
    return std::pow(std::clamp(1 - cosine, 0.0, 1.0), 5);
}

/// What a lobe gets from microfacets that light meets after the first, 1 counted, by the
/// reflectance of its facets on the mean (Turquin 2019; what is absorbed on the way: Kulla and
/// Conty 2017).
dvec3 givenBack(const dvec3& mean, double albedo, double meanAlbedo) {
    const dvec3 kept = mean * meanAlbedo / (1.0 - mean * (1 - meanAlbedo));
    return 1.0 + kept * ((1 - albedo) / albedo);
}

dvec3 meanOf(const dvec3& f0, double f90) {
    return mixed(f0, f90, double(gpu::MEAN_SCHLICK_WEIGHT));
}

dvec3 turned(const dvec3& w, double angle) {
    return {std::cos(angle) * w.x - std::sin(angle) * w.y,
            std::sin(angle) * w.x + std::cos(angle) * w.y, w.z};
}

/// A direction's value f |cos| and density by one of the lobes alone.
struct Part {
    dvec3 value{0.0};
    double pdf = 0;
};

/// The material as it is seen from wo.
class Layers {
  public:
    Layers(const PrincipledParameters& p, const dvec3& wo, bool entering, const dvec3& coat);

    BsdfValue evaluate(const dvec3& wi) const;
    BsdfSample sample(const dvec3& u) const;
    BsdfSample sampleOnPlane(double u) const; ///< of clear glass

  private:
    struct Facet {
        dvec3 reflected{0.0}, transmitted{0.0};
        double reflects = 1; ///< share of samples
    };
    Facet facetAt(double cosine, int channel) const;
    Part facets(const dvec3& wi) const;
    Part facets(const dvec3& wi, int channel) const;
    dvec3 halfVector(const dvec3& wi, int channel) const;
    Part coat(const dvec3& wi) const;
    dvec3 interfaceReflectance(double cosine, int channel) const;
    dvec3 withFilm(const dvec3& plain, double cosine, const dvec3& f0, double f90) const;

    const PrincipledParameters& p_;
    dvec3 wo_, grainWo_; ///< the latter in the frame of the facets
    Frame coatFrame_;
    dvec3 coatWo_;
    bool thin_, covered_;
    double index_;
    dvec3 indices_, etas_; ///< by channel
    bool disperses_;
    dvec3 baseColor_, f0_;
    double f90_;
    Ggx ggx_{1, 1}, coatGgx_{1, 1};
    double albedo_ = 1, meanAlbedo_ = 1, coatAlbedo_ = 1, coatGiven_ = 1, sheenAlpha_ = 1;
    double opaque_, clear_; ///< shares of dielectric over diffuse, and over transmission
    double underCoat_ = 1, underSheen_ = 1;
    dvec3 diffuse_{0.0}, through_{0.0}, sheen_{0.0};
    dvec3 meanDielectric_, meanMetal_; ///< by which light is given back
    double facetShare_ = 1, diffuseShare_ = 0, throughShare_ = 0, sheenShare_ = 0, coatShare_ = 0;
};

Layers::Layers(const PrincipledParameters& p, const dvec3& wo, bool entering, const dvec3& coat)
    : p_(p), wo_(wo), grainWo_(turned(wo, -double(p.anisotropyRotation))), coatFrame_(coat),
      coatWo_(coatFrame_.toLocal(wo)), thin_(!refracts(p)), covered_(p.isThin || entering),
      index_(usedIndex(p)), indices_(indicesOf(p)), etas_(entering ? 1.0 / indices_ : indices_),
      disperses_(indices_.x != indices_.z), baseColor_(p.baseColor), f90_(p.specular),
      opaque_((1 - double(p.metallic)) * (1 - double(p.transmission))),
      clear_((1 - double(p.metallic)) * double(p.transmission)) {
    const double r = (index_ - 1) / (index_ + 1);
    f0_ = glm::min(r * r * dvec3(p.specularColor), dvec3(1.0)) * double(p.specular);

    double least = gpu::LEAST_GGX_ALPHA;
    if (refracts(p)) // red light is refracted least
        least = std::max(least, gpu::LEAST_REFRACTION_ALPHA * std::max(indices_.x, 1.0) /
                                    std::abs(indices_.x - 1));
    const double alpha = std::max(double(p.roughness) * p.roughness, least);
    const double strength = p.anisotropy;
    ggx_ = {alpha + (1 - alpha) * strength * strength, alpha};

    if (covered_ && p.clearcoat > 0 && coatWo_.z > 0) {
        const double rough = double(p.clearcoatRoughness) * p.clearcoatRoughness;
        const double coatAlpha = std::max(rough, double(gpu::LEAST_GGX_ALPHA));
        coatGgx_ = {coatAlpha, coatAlpha};
        coatAlbedo_ = gpu::ggxAlbedo(coatWo_.z, coatAlpha);
        const dvec3 f0(double(gpu::CLEARCOAT_F0));
        const dvec3 fresnel = mixed(f0, 1, gpu::schlickShare(coatWo_.z, coatAlpha));
        coatGiven_ = givenBack(meanOf(f0, 1), coatAlbedo_, gpu::ggxMeanAlbedo(coatAlpha)).x;
        coatShare_ = p.clearcoat * coatAlbedo_ * fresnel.x * coatGiven_;
        underCoat_ = 1 - coatShare_;
    }
    if (covered_) {
        sheenAlpha_ =
            std::max(double(p.sheenRoughness) * p.sheenRoughness, double(gpu::LEAST_SHEEN_ALPHA));
        const double sheenAlbedo =
            gpu::sheenAlbedo(std::max(wo.z, double(gpu::LEAST_SHEEN_COSINE)), sheenAlpha_);
        sheen_ = underCoat_ * dvec3(p.sheenColor);
        sheenShare_ = mean(sheen_) * sheenAlbedo;
        underSheen_ = std::max(underCoat_ - largestComponent(sheen_) * sheenAlbedo, 0.0);
    } else {
        underSheen_ = underCoat_;
    }
    albedo_ = gpu::ggxAlbedo(wo.z, ggx_.alphaY);
    meanAlbedo_ = gpu::ggxMeanAlbedo(ggx_.alphaY);
    if (p.isClear()) albedo_ = meanAlbedo_ = 1; // whose facets are one plane
    const double weight = gpu::schlickShare(wo.z, ggx_.alphaY);
    // At the cosine whose Schlick weight is the facets' mean one.
    const double cosine = 1 - std::pow(std::clamp(weight, 0.0, 1.0), 0.2);
    meanDielectric_ = withFilm(meanOf(f0_, f90_), cosine, f0_, f90_);
    meanMetal_ = withFilm(meanOf(baseColor_, 1), cosine, baseColor_, 1);
    const dvec3 dielectric = albedo_ * withFilm(mixed(f0_, f90_, weight), cosine, f0_, f90_) *
                             givenBack(meanDielectric_, albedo_, meanAlbedo_);
    const dvec3 metal = albedo_ * withFilm(mixed(baseColor_, 1, weight), cosine, baseColor_, 1) *
                        givenBack(meanMetal_, albedo_, meanAlbedo_);
    const double base = underSheen_ * opaque_ * std::max(1 - largestComponent(dielectric), 0.0);
    const double passes = p.diffuseTransmission;
    diffuse_ = base * (1 - passes) * baseColor_;
    through_ = base * passes * dvec3(p.diffuseTransmissionColor);
    diffuseShare_ = mean(diffuse_);
    throughShare_ = mean(through_);
    constexpr double kLeastFacets = 1.0 / 64;
    facetShare_ =
        std::max(underSheen_ * (mean(double(p.metallic) * metal + opaque_ * dielectric) + clear_),
                 kLeastFacets);
    const double sum = facetShare_ + diffuseShare_ + throughShare_ + sheenShare_ + coatShare_;
    for (double* share : {&facetShare_, &diffuseShare_, &throughShare_, &sheenShare_, &coatShare_})
        *share /= sum;
}

/// What the film, if any, makes of a reflectance of the surface, from f0 to f90.
dvec3 Layers::withFilm(const dvec3& plain, double cosine, const dvec3& f0, double f90) const {
    if (!(p_.iridescence > 0)) return plain;
    if (!(f90 > 0)) return plain * (1 - double(p_.iridescence));
    const ThinFilm film{p_.filmIor, double(p_.filmThickness) + p_.filmSpan};
    return glm::mix(plain, f90 * film.reflectance(cosine, f0 / f90), double(p_.iridescence));
}

dvec3 Layers::interfaceReflectance(double cosine, int channel) const {
    const Interface face = dielectric(std::min(cosine, 1.0), etas_[channel]);
    if (face.total) return dvec3(1.0);
    const double n = indices_[channel], normal = square((n - 1) / (n + 1));
    const dvec3 plain = mixed(f0_, f90_, std::max((face.reflectance - normal) / (1 - normal), 0.0));
    // Film and surface reflect as much from below as from where such light goes to.
    return withFilm(plain, covered_ ? std::min(cosine, 1.0) : face.cosTransmitted, f0_, f90_);
}

Layers::Facet Layers::facetAt(double cosine, int channel) const {
    const double weight = schlickWeight(cosine), metallic = p_.metallic;
    const double met = std::min(cosine, 1.0);
    const dvec3 dielectric = withFilm(mixed(f0_, f90_, weight), met, f0_, f90_);
    Facet f;
    f.reflected = metallic * withFilm(mixed(baseColor_, 1, weight), met, baseColor_, 1) *
                      givenBack(meanMetal_, albedo_, meanAlbedo_) +
                  opaque_ * dielectric * givenBack(meanDielectric_, albedo_, meanAlbedo_);
    if (clear_ == 0) return f;
    const dvec3 mirrored = thin_ ? dielectric : interfaceReflectance(cosine, channel);
    // All that a thin sheet's facets do not send on at first is given back.
    const double scale = thin_ ? clear_ / albedo_ : clear_;
    f.reflected += scale * mirrored;
    f.transmitted = scale * std::max(1 - largestComponent(mirrored), 0.0) * baseColor_;
    const double r = mean(f.reflected), t = mean(f.transmitted);
    if (t > 0) f.reflects = r / (r + t);
    if (!thin_)
        f.transmitted *= square(etas_[channel]); // radiance over the squared index is invariant
    return f;
}

/// The normal of the facets that send light from wi to wo, in their frame; 0 where none does.
dvec3 Layers::halfVector(const dvec3& wi, int channel) const {
    if (wi.z > 0) return glm::normalize(grainWo_ + wi);
    if (thin_) return glm::normalize(grainWo_ + dvec3(wi.x, wi.y, -wi.z));
    dvec3 h = -(etas_[channel] * grainWo_ + wi);
    if (h.z < 0) h = -h;
    h = glm::normalize(h);
    return glm::dot(grainWo_, h) > 0 && glm::dot(wi, h) < 0 ? h : dvec3(0.0);
}

/// Samples take the index of any of the channels, each in a third of the cases.
Part Layers::facets(const dvec3& wi) const {
    if (!disperses_) return facets(wi, 1);
    Part all;
    for (int channel = 0; channel < 3; ++channel) {
        const Part one = facets(wi, channel);
        all.value[channel] = one.value[channel];
        all.pdf += one.pdf / 3;
    }
    return all;
}

Part Layers::facets(const dvec3& worldWi, int channel) const {
    const dvec3 wi = turned(worldWi, -double(p_.anisotropyRotation));
    const dvec3 h = halfVector(wi, channel);
    const double cosO = glm::dot(grainWo_, h);
    if (!(cosO > 0)) return {};
    const Facet facet = facetAt(cosO, channel);
    const double d = ggx_.density(h), g2 = ggx_.visibleFromBoth(grainWo_, wi);
    const double pdfOfH = ggx_.visibleDensity(grainWo_, h);
    if (wi.z > 0)
        return {facet.reflected * (d * g2 / (4 * wo_.z)), facet.reflects * pdfOfH / (4 * cosO)};
    if (thin_)
        return {facet.transmitted * (d * g2 / (4 * wo_.z)),
                (1 - facet.reflects) * pdfOfH / (4 * cosO)};
    // Walter et al. 2007, equations 17 and 21, the far side's index taken as 1.
    const double cosI = std::abs(glm::dot(wi, h));
    const double jacobian = cosI / square(etas_[channel] * cosO - cosI);
    return {facet.transmitted * (d * g2 * cosO * jacobian / wo_.z),
            (1 - facet.reflects) * pdfOfH * jacobian};
}

Part Layers::coat(const dvec3& baseWi) const {
    const dvec3 wi = coatFrame_.toLocal(baseWi);
    if (!(wi.z > 0)) return {};
    const dvec3 h = glm::normalize(coatWo_ + wi);
    const dvec3 f0(double(gpu::CLEARCOAT_F0));
    const double f =
        mixed(f0, 1, schlickWeight(glm::dot(coatWo_, h))).x * coatGiven_ * p_.clearcoat;
    return {
        dvec3(f * coatGgx_.density(h) * coatGgx_.visibleFromBoth(coatWo_, wi) / (4 * coatWo_.z)),
        coatGgx_.visibleDensity(coatWo_, h) / (4 * glm::dot(coatWo_, h))};
}

BsdfValue Layers::evaluate(const dvec3& wi) const {
    const Part facet = facets(wi);
    BsdfValue f{underSheen_ * facet.value, facetShare_ * facet.pdf};
    if (!(wi.z > 0)) {
        f.value += through_ * (-wi.z / kPi);
        f.pdf += throughShare_ * (-wi.z / kPi);
        return f;
    }
    f.value += diffuse_ * (wi.z / kPi);
    f.pdf += diffuseShare_ * (wi.z / kPi);
    if (sheenShare_ > 0) {
        f.value += sheen_ * (sheen(sheenAlpha_, wo_, wi) * wi.z);
        f.pdf += sheenShare_ / (2 * kPi);
    }
    if (coatShare_ > 0) {
        const Part top = coat(wi);
        f.value += top.value;
        f.pdf += coatShare_ * top.pdf;
    }
    return f;
}

BsdfSample Layers::sample(const dvec3& u) const {
    BsdfSample s;
    s.lobe = gpu::LOBE_GLOSSY_REFLECTION;
    double pick = u.z;
    if (pick < diffuseShare_) {
        s.direction = cosineHemisphere(u.x, u.y);
    } else if ((pick -= diffuseShare_) < throughShare_) {
        s.direction = cosineHemisphere(u.x, u.y);
        s.direction.z = -s.direction.z;
        s.lobe = gpu::LOBE_GLOSSY_TRANSMISSION;
    } else if ((pick -= throughShare_) < sheenShare_) {
        s.direction = uniformHemisphere(u.x, u.y);
    } else if ((pick -= sheenShare_) < coatShare_) {
        const dvec3 h = coatGgx_.sampleVisible(coatWo_, u.x, u.y);
        const dvec3 wi = 2 * glm::dot(coatWo_, h) * h - coatWo_;
        if (!(wi.z > 0)) return s; // below the coat's own horizon, where it has no density
        s.direction = coatFrame_.toWorld(wi);
    } else {
        double left = std::min((pick - coatShare_) / facetShare_, 1.0);
        int channel = 1;
        if (disperses_) {
            channel = std::min(int(3 * left), 2);
            left = 3 * left - channel;
        }
        const dvec3 h = ggx_.sampleVisible(grainWo_, u.x, u.y);
        const double cosine = glm::dot(grainWo_, h);
        const Facet facet = facetAt(cosine, channel);
        dvec3 wi = 2 * cosine * h - grainWo_;
        if (left >= facet.reflects) {
            s.lobe = gpu::LOBE_GLOSSY_TRANSMISSION;
            if (thin_)
                wi.z = -wi.z;
            else
                wi = (etas_[channel] * cosine -
                      dielectric(std::min(cosine, 1.0), etas_[channel]).cosTransmitted) *
                         h -
                     etas_[channel] * grainWo_;
        }
        s.direction = turned(wi, double(p_.anisotropyRotation));
    }
    if (s.transmitted() ? s.direction.z >= 0 : s.direction.z <= 0) return s;
    const BsdfValue f = evaluate(s.direction);
    s.pdf = f.pdf;
    if (f.pdf > 0) s.weight = f.value / f.pdf;
    return s;
}

BsdfSample Layers::sampleOnPlane(double u) const {
    const Facet facet = facetAt(wo_.z, 1);
    BsdfSample s;
    const bool passes = u >= facet.reflects;
    s.chosen = passes ? 1 - facet.reflects : facet.reflects;
    s.lobe = passes ? gpu::LOBE_DELTA_TRANSMISSION : gpu::LOBE_DELTA_REFLECTION;
    s.weight = (passes ? facet.transmitted : facet.reflected) / s.chosen;
    s.direction = passes ? -wo_ : dvec3(-wo_.x, -wo_.y, wo_.z);
    if (passes && !thin_) {
        const double cosine = dielectric(std::min(wo_.z, 1.0), etas_.y).cosTransmitted;
        s.direction = {-etas_.y * wo_.x, -etas_.y * wo_.y, -cosine};
    }
    return s;
}

} // namespace

uint32_t principledLobes(const PrincipledParameters& p) {
    const uint32_t diffuse = gpu::LOBE_DIFFUSE_TRANSMISSION | gpu::LOBE_GLOSSY_TRANSMISSION;
    return gpu::LOBE_GLOSSY_REFLECTION | (transmits(p) ? gpu::LOBE_GLOSSY_TRANSMISSION : 0) |
           (p.passesDiffusely() ? diffuse : 0);
}

BsdfValue evaluatePrincipled(const PrincipledParameters& p, const dvec3& wo, bool entering,
                             const dvec3& wi, const dvec3& coat) {
    if (!(wo.z > 0) || wi.z == 0 || (wi.z < 0 && !transmits(p) && !p.passesDiffusely())) return {};
    return Layers(p, wo, entering, coat).evaluate(wi);
}

BsdfSample samplePrincipled(const PrincipledParameters& p, const dvec3& wo, bool entering,
                            const dvec3& u, const dvec3& coat) {
    if (!(wo.z > 0)) return {};
    return Layers(p, wo, entering, coat).sample(u);
}

BsdfSample sampleClearPrincipled(const PrincipledParameters& p, const dvec3& wo, bool entering,
                                 double u) {
    if (!(wo.z > 0)) return {};
    return Layers(p, wo, entering, {0, 0, 1}).sampleOnPlane(u);
}

dvec3 absorption(const PrincipledParameters& p) {
    if (p.isThin || !(transmits(p) || p.passesDiffusely())) return dvec3(0.0);
    constexpr double kLeastTransmitted = 1e-30;
    return -glm::log(glm::max(dvec3(p.attenuationColor), kLeastTransmitted)) /
           double(p.attenuationDistance);
}

} // namespace stromboli::reference

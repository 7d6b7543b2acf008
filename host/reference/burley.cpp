#include "host/reference/burley.hpp"

#include "host/reference/microfacet.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

using glm::dvec3;

double schlickWeight(double cosine) {
    return std::pow(std::clamp(1 - cosine, 0.0, 1.0), 5);
}

dvec3 towardsWhite(const dvec3& f0, double weight) {
    return f0 + (1.0 - f0) * weight;
}

/// Burley 2012: roughness squared, its aspect from the anisotropy.
Ggx facetsOf(const BurleyParameters& p, double roughness) {
    const double aspect = std::sqrt(1 - 0.9 * double(p.anisotropy)), least = p.leastAlpha();
    return {std::max(square(roughness) / aspect, least),
            std::max(square(roughness) * aspect, least)};
}

/// Generalised Trowbridge-Reitz of the exponent 1.
double gtr1(const dvec3& h, double alpha) {
    const double a2 = square(alpha), sin2 = square(h.x) + square(h.y);
    return (a2 - 1) / (kPi * std::log(a2) * (sin2 + a2 * square(h.z)));
}

/// The material as it is seen from wo: a sum of lobes.
class Lobes {
  public:
    Lobes(const BurleyParameters& p, const dvec3& wo, bool entering);

    BsdfValue evaluate(const dvec3& wi) const;
    BsdfSample sample(const dvec3& u) const;

  private:
    struct Facet {
        dvec3 reflected{0.0}, transmitted{0.0};
        double reflects = 1; ///< share of samples
        double cosTransmitted = 0;
    };
    Facet facetAt(double cosine) const;
    BsdfValue facets(const dvec3& wi) const;
    BsdfValue coat(const dvec3& wi) const;
    dvec3 diffuse(const dvec3& wi) const;
    double schlickAt(double cosine) const;

    const BurleyParameters& p_;
    dvec3 wo_, base_, tint_{1.0};
    bool inside_;
    double eta_;
    Ggx outer_{1, 1}, through_{1, 1}; ///< facets that reflect or refract, and those of thin sheets
    double opaque_, clear_, sheen_, coatAlpha_;
    double facetShare_, reflectedShare_, throughShare_, coatShare_;
};

Lobes::Lobes(const BurleyParameters& p, const dvec3& wo, bool entering)
    : p_(p), wo_(wo), base_(p.baseColor),
      // What lets no light in has no inside.
      inside_(!p.isThin && !entering && p.transmission > 0) {
    const double ior = p.usedIor(), t = p.transmission;
    eta_ = inside_ ? ior : 1 / ior;
    const double luminance = glm::dot(base_, dvec3(0.212671, 0.715160, 0.072169));
    if (luminance > 0) tint_ = base_ / luminance;
    outer_ = facetsOf(p, p.roughness);
    through_ = p.isThin ? facetsOf(p, (0.65 * ior - 0.35) * p.roughness) : outer_;
    const double dielectric = p.isThin ? 1 : 1 - double(p.metallic);
    opaque_ = inside_ ? 0 : dielectric * (1 - t);
    clear_ = dielectric * t;
    sheen_ = inside_ ? 0 : (p.isThin ? 1 - t : dielectric) * double(p.sheen);
    coatAlpha_ = 0.1 + (0.001 - 0.1) * double(p.clearcoatGloss);
    const double widely = std::max(opaque_, sheen_ / 4);
    coatShare_ = inside_ || p.isThin ? 0 : double(p.clearcoat) / 4;
    facetShare_ = p.isThin ? t : 1;
    const double sum = widely + coatShare_ + facetShare_;
    const double passing = p.isThin ? double(p.diffuseTransmission) : 0;
    reflectedShare_ = widely * (1 - passing) / sum;
    throughShare_ = widely * passing / sum;
    coatShare_ /= sum;
    facetShare_ /= sum;
}

/// On the denser side Schlick's approximation takes the angle on the other one.
double Lobes::schlickAt(double cosine) const {
    return schlickWeight(eta_ < 1 ? cosine
                                  : dielectric(std::min(cosine, 1.0), eta_).cosTransmitted);
}

Lobes::Facet Lobes::facetAt(double cosine) const {
    const Interface face = dielectric(std::min(cosine, 1.0), eta_);
    const double f = face.reflectance, ior = p_.usedIor(), tinted = p_.specularTint;
    const double metallic = p_.isThin ? 0 : double(p_.metallic), weight = schlickAt(cosine);
    const dvec3 specular =
        (1 - tinted) * f + tinted * towardsWhite(tint_ * square((ior - 1) / (ior + 1)), weight);
    Facet facet;
    facet.cosTransmitted = face.cosTransmitted;
    if (p_.isThin) {
        facet.reflected = clear_ * specular;
        facet.transmitted = clear_ * (1 - f) * base_;
        facet.reflects = 0.5;
        return facet;
    }
    facet.reflected = inside_ ? dvec3(clear_ * f)
                              : (1 - metallic) * specular + metallic * towardsWhite(base_, weight);
    facet.transmitted = clear_ * (1 - f) * glm::sqrt(base_);
    const double r = mean(facet.reflected), through = mean(facet.transmitted);
    if (through > 0) facet.reflects = r / (r + through);
    facet.transmitted *= eta_ * eta_; // radiance over the squared index is invariant
    return facet;
}

/// Walter et al. 2007, equations 20 and 21; those of a thin sheet send on what they would reflect.
BsdfValue Lobes::facets(const dvec3& wi) const {
    const bool isBelow = wi.z < 0, refracts = isBelow && !p_.isThin;
    const Ggx& ggx = isBelow ? through_ : outer_;
    dvec3 h = refracts ? -(eta_ * wo_ + wi) : wo_ + dvec3(wi.x, wi.y, std::abs(wi.z));
    if (h.z < 0) h = -h;
    h = glm::normalize(h);
    const double cosO = glm::dot(wo_, h), cosI = glm::dot(wi, h);
    if (!(cosO > 0) || (refracts && !(cosI < 0))) return {};
    const Facet facet = facetAt(cosO);
    // Facets of a thin sheet do not send light on to their own side.
    const bool isLit = !isBelow || cosI < 0;
    const double masked = isLit ? 1 / ((1 + ggx.lambda(wo_)) * (1 + ggx.lambda(wi))) : 0;
    const double jacobian =
        refracts ? -cosI / square(eta_ * cosO + cosI) : 1 / (4 * cosO); // dh over dwi
    const double value = ggx.density(h) * masked * cosO * jacobian / wo_.z;
    const double pdf = ggx.visibleDensity(wo_, h) * jacobian;
    return isBelow ? BsdfValue{facet.transmitted * value, (1 - facet.reflects) * pdf}
                   : BsdfValue{facet.reflected * value, facet.reflects * pdf};
}

BsdfValue Lobes::coat(const dvec3& wi) const {
    const dvec3 h = glm::normalize(wo_ + wi);
    const double cosine = glm::dot(wo_, h), d = gtr1(h, coatAlpha_);
    const double f0 = double(gpu::CLEARCOAT_F0), f = f0 + (1 - f0) * schlickAt(cosine);
    const Ggx masking{0.25, 0.25};
    const double g = 1 / ((1 + masking.lambda(wo_)) * (1 + masking.lambda(wi)));
    return {dvec3(0.25 * double(p_.clearcoat) * f * d * g * wi.z), d * h.z / (4 * cosine)};
}

/// f cos of what is scattered widely, upwards.
dvec3 Lobes::diffuse(const dvec3& wi) const {
    const double cosD = glm::dot(wi, glm::normalize(wo_ + wi));
    const double out = schlickWeight(wi.z), in = schlickWeight(wo_.z);
    const double rr = 2 * double(p_.roughness) * square(cosD);
    const double lambert = (1 - out / 2) * (1 - in / 2);
    const double retro = rr * (out + in + out * in * (rr - 1));
    const double fss = (1 + (rr / 2 - 1) * out) * (1 + (rr / 2 - 1) * in);
    const double subsurface = 1.25 * (fss * (1 / (wi.z + wo_.z) - 0.5) + 0.5);
    const double flat = p_.flatness;
    const dvec3 sheen = sheen_ * schlickWeight(cosD) * (1.0 + double(p_.sheenTint) * (tint_ - 1.0));
    const dvec3 all =
        opaque_ / kPi * ((1 - flat) * (lambert + retro) + flat * subsurface) * base_ + sheen;
    return all * wi.z * (p_.isThin ? 1 - double(p_.diffuseTransmission) : 1);
}

BsdfValue Lobes::evaluate(const dvec3& wi) const {
    BsdfValue f;
    if (facetShare_ > 0) f = facets(wi);
    f.pdf *= facetShare_;
    const double lambert = std::abs(wi.z) / kPi;
    if (wi.z < 0) {
        if (!p_.isThin) return f;
        f.value += opaque_ * double(p_.diffuseTransmission) * lambert * base_;
        f.pdf += throughShare_ * lambert;
        return f;
    }
    if (inside_) return f;
    f.value += diffuse(wi);
    f.pdf += reflectedShare_ * lambert;
    if (coatShare_ > 0) {
        const BsdfValue top = coat(wi);
        f.value += top.value;
        f.pdf += coatShare_ * top.pdf;
    }
    return f;
}

BsdfSample Lobes::sample(const dvec3& u) const {
    BsdfSample s;
    s.lobe = gpu::LOBE_GLOSSY_REFLECTION;
    double pick = u.z;
    if (pick < reflectedShare_) {
        s.direction = cosineHemisphere(u.x, u.y);
    } else if ((pick -= reflectedShare_) < throughShare_) {
        s.direction = -cosineHemisphere(u.x, u.y);
        s.lobe = gpu::LOBE_GLOSSY_TRANSMISSION;
    } else if ((pick -= throughShare_) < coatShare_) {
        const double a2 = square(coatAlpha_);
        const double z = std::sqrt((1 - std::pow(a2, 1 - u.x)) / (1 - a2));
        const double r = std::sqrt(std::max(1 - z * z, 0.0)), phi = 2 * kPi * u.y;
        const dvec3 h(r * std::cos(phi), r * std::sin(phi), z);
        s.direction = 2 * glm::dot(wo_, h) * h - wo_;
    } else {
        const double left = std::min((pick - coatShare_) / facetShare_, 1.0);
        const bool isThrough = p_.isThin && left >= 0.5;
        const dvec3 h = (isThrough ? through_ : outer_).sampleVisible(wo_, u.x, u.y);
        const double cosine = glm::dot(wo_, h);
        const Facet facet = facetAt(cosine);
        s.direction = 2 * cosine * h - wo_;
        if (left >= facet.reflects) {
            s.lobe = gpu::LOBE_GLOSSY_TRANSMISSION;
            if (p_.isThin)
                s.direction.z = -s.direction.z;
            else
                s.direction = (eta_ * cosine - facet.cosTransmitted) * h - eta_ * wo_;
        }
    }
    if (s.transmitted() ? s.direction.z >= 0 : s.direction.z <= 0) return s;
    const BsdfValue f = evaluate(s.direction);
    s.pdf = f.pdf;
    if (f.pdf > 0) s.weight = f.value / f.pdf;
    return s;
}

} // namespace

uint32_t burleyLobes(const BurleyParameters& p) {
    return gpu::LOBE_GLOSSY_REFLECTION | (p.transmits() ? gpu::LOBE_GLOSSY_TRANSMISSION : 0);
}

BsdfValue evaluateBurley(const BurleyParameters& p, const dvec3& wo, bool entering,
                         const dvec3& wi) {
    if (!(wo.z > 0) || wi.z == 0 || (wi.z < 0 && !p.transmits())) return {};
    return Lobes(p, wo, entering).evaluate(wi);
}

BsdfSample sampleBurley(const BurleyParameters& p, const dvec3& wo, bool entering, const dvec3& u) {
    if (!(wo.z > 0)) return {};
    return Lobes(p, wo, entering).sample(u);
}

bool isNarrow(const BurleyParameters& p) {
    constexpr double kNarrow = 0.5; // facets within 14 degrees
    return p.roughness < kNarrow || p.clearcoat > 0;
}

} // namespace stromboli::reference

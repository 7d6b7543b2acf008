#include "host/reference/near_lights.hpp"

#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

/// The share of distances by extinction with the least second moment, as far as it can be told.
/// rest: what arrives along the ray from all else; glow: what the lamps send into it; excess: by
/// extinction alone, the second moment of the glow over its square.
double shareByExtinction(double rest, double glow, double excess) {
    const double gain = excess * (excess - 1);
    if (!(excess > 1) || !(glow * glow * gain > rest * rest)) return 1;
    return std::max(rest * excess / (rest * (excess - 1) + glow * std::sqrt(gain)), 0.5);
}

} // namespace

NearLights::NearLights(const LightFoci& foci, const Medium& medium, const Ray& ray, double from,
                       double to, const glm::dvec3& share) {
    constexpr double kLeastAngle = 0.1;
    const double extinction = glm::dot(share, glm::dvec3(medium.extinction()));
    const double scattering = glm::dot(share, glm::dvec3(medium.scattering));
    double rest = foci.others, excess = 0, glow = 0;
    for (const LightFocus& focus : foci.near) {
        const glm::dvec3 d = focus.point - (ray.origin + from * ray.direction);
        const double square = focus.radius * focus.radius;
        Near near{};
        near.closest = glm::dot(d, ray.direction);
        const glm::dvec3 across = d - near.closest * ray.direction;
        near.apart = std::sqrt(glm::dot(across, across) + square);
        near.first = std::atan(-near.closest / near.apart);
        near.all = std::atan((to - from - near.closest) / near.apart) - near.first;
        if (to < kInfinity) {
            const double beyond = to - from - near.closest;
            const double end = glm::dot(across, across) + beyond * beyond;
            rest += focus.intensity / (kPi * std::max(end, square));
            if (end < 1.01 * square) rest += focus.radiance;
        }
        if (near.all < kLeastAngle) continue;
        const double sent = scattering * focus.intensity * near.all / (4 * kPi * near.apart);
        excess += sent / (2 * extinction * near.apart * near.all);
        glow += sent;
        near.weight = glow;
        near_.push_back(near);
    }
    if (glow > 0) share_ = 1 - shareByExtinction(rest, glow, excess / glow);
}

double NearLights::draw(double which, double u) const {
    size_t i = 0;
    while (i + 1 < near_.size() && which * near_.back().weight >= near_[i].weight)
        ++i;
    const Near& n = near_[i];
    return n.closest + n.apart * std::tan(n.first + u * n.all);
}

double NearLights::density(double distance) const {
    double sum = 0, before = 0;
    for (const Near& n : near_) {
        const double d = distance - n.closest;
        sum += (n.weight - before) / near_.back().weight * n.apart /
               (n.all * (n.apart * n.apart + d * d));
        before = n.weight;
    }
    return sum;
}

} // namespace stromboli::reference

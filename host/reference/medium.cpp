#include "host/reference/medium.hpp"

#include "host/reference/near_lights.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stromboli::reference {
namespace {

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

glm::dvec3 exponential(const glm::dvec3& extinction, double length) {
    glm::dvec3 left(1.0);
    for (int c = 0; c < 3; ++c) // the distance may be infinite
        if (extinction[c] > 0) left[c] = std::exp(-extinction[c] * length);
    return left;
}

/// The part of a ray in the unit cube of a grid.
struct Stretch {
    glm::dvec3 origin, direction; ///< in the cube's coordinates
    double from, to;
};

template <class Value>
Stretch withinCube(const Grid<Value>& grid, const Ray& ray, double from, double to) {
    Stretch s{grid.place(ray.origin), glm::dvec3(0), from, to};
    for (int i = 0; i < 3; ++i) {
        s.direction[i] = glm::dot(glm::dvec3(grid.toUnit[size_t(i)]), ray.direction);
        const double o = s.origin[i], d = s.direction[i];
        if (d == 0) {
            if (o < 0 || o > 1) s.to = s.from;
            continue;
        }
        const double toLow = -o / d, toHigh = (1 - o) / d;
        s.from = std::max(s.from, std::min(toLow, toHigh));
        s.to = std::min(s.to, std::max(toLow, toHigh));
    }
    return s;
}

/// The integral of a grid along a ray. Between the planes through the middles of cells it is a
/// cubic polynomial, for which Simpson's rule is exact.
template <class Value>
typename Grid<Value>::Exact integrate(const Grid<Value>& grid, const Ray& ray, double from,
                                      double to) {
    const Stretch s = withinCube(grid, ray, from, to);
    typename Grid<Value>::Exact sum(0.0);
    if (!(s.to > s.from)) return sum;
    std::vector<double> ends{s.from, s.to};
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t i = 0; i < grid.size[axis] && s.direction[axis] != 0; ++i) {
            const double t = ((i + 0.5) / grid.size[axis] - s.origin[axis]) / s.direction[axis];
            if (t > s.from && t < s.to) ends.push_back(t);
        }
    std::ranges::sort(ends);
    const auto value = [&](double t) { return grid.goingOn(s.origin + t * s.direction); };
    for (size_t i = 1; i < ends.size(); ++i) {
        const double a = ends[i - 1], b = ends[i], middle = (a + b) / 2;
        sum += (b - a) / 6 * (value(a) + 4.0 * value(middle) + value(b));
    }
    return sum;
}

/// Woodcock's tentative collisions at a rate that is nowhere exceeded, for three channels at once.
MediumEvent trackGrid(const Medium& m, double rate, const Ray& ray, double from, double to,
                      const glm::dvec3& carried, RandomStream& random) {
    MediumEvent event;
    const Stretch s = m.colors.extinction ? withinCube(*m.colors.extinction, ray, from, to)
                                          : withinCube(*m.density, ray, from, to);
    if (!(rate > 0)) return event;
    for (double t = s.from;;) {
        t -= std::log(1 - random.next()) / rate;
        if (!(t < s.to)) return event;
        const MediumPoint p = m.at(ray.origin + t * ray.direction, s.origin + t * s.direction);
        event.shone += event.weight * p.emission / rate;
        const glm::dvec3 real = p.scattering / rate;
        const glm::dvec3 none = glm::max(1.0 - p.extinction / rate, 0.0);
        const double ofReal = glm::dot(carried * event.weight, real);
        const double all = ofReal + glm::dot(carried * event.weight, none);
        event.scatters = random.next() * all < ofReal;
        event.distance = t;
        if (!(all > 0)) {
            event.weight = glm::dvec3(0.0);
            return event;
        }
        event.weight *= event.scatters ? real * (all / ofReal) : none * (all / (all - ofReal));
        if (event.scatters) return event;
    }
}

} // namespace

double mostExtinction(const Medium& m) {
    const glm::dvec3 whole(m.extinction());
    if (m.colors.extinction) return largest(whole * glm::dvec3(m.colors.extinction->largest()));
    return m.density ? largest(whole) * double(m.density->largest()) : largest(whole);
}

MediumEvent flyThrough(const Medium& m, double most, const Ray& ray, double from, double to,
                       const glm::dvec3& carried, const LightFoci* foci, RandomStream& random) {
    if (m.varies()) return trackGrid(m, most, ray, from, to, carried, random);
    MediumEvent event;
    const glm::dvec3 extinction(m.extinction()), scattering(m.scattering);
    const double length = to - from;
    event.weight = exponential(extinction, length);
    for (int c = 0; c < 3; ++c)
        event.shone[c] = m.emission[c] * (extinction[c] > 0
                                              ? -std::expm1(-extinction[c] * length) / extinction[c]
                                          : m.emission[c] > 0 ? length
                                                              : 0.0);
    if (!m.scatters()) return event;
    const glm::dvec3 share = carried / (carried.x + carried.y + carried.z);
    const NearLights near =
        foci && !m.isUnderSurface ? NearLights(*foci, m, ray, from, to, share) : NearLights();
    const double byExtinction = 1 - near.share();
    double distance = 0;
    if (near.share() > 0 && random.next() >= byExtinction) {
        const double which = random.next();
        distance = near.draw(which, random.next());
        event.scatters = true;
    } else {
        const double which = random.next(), depth = -std::log(1 - random.next());
        const int channel = which < share.x ? 0 : which < share.x + share.y ? 1 : 2;
        distance = extinction[channel] > 0 ? depth / extinction[channel] : kInfinity;
        event.scatters = distance < length;
    }
    const glm::dvec3 left = exponential(extinction, std::min(distance, length));
    event.distance = from + distance;
    double density = byExtinction * glm::dot(share, event.scatters ? extinction * left : left);
    if (event.scatters && near.share() > 0) density += near.share() * near.density(distance);
    event.weight = (event.scatters ? scattering * left : left) / density;
    return event;
}

glm::dvec3 transmittance(const Medium& m, const Ray& ray, double from, double to) {
    const glm::dvec3 extinction(m.extinction());
    if (m.colors.extinction)
        return exponential(extinction * integrate(*m.colors.extinction, ray, from, to), 1);
    return exponential(extinction, m.density ? integrate(*m.density, ray, from, to) : to - from);
}

namespace {

double phaseDensity(const PhaseLobe& lobe, double cosine) {
    if (lobe.phase == PhaseFunction::Rayleigh) return 3 / (16 * kPi) * (1 + cosine * cosine);
    const double g = lobe.asymmetry;
    return (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

bool isNarrow(const PhaseLobe& lobe) {
    constexpr float kNarrow = 0.75f;
    return lobe.phase == PhaseFunction::HenyeyGreenstein && std::abs(lobe.asymmetry) > kNarrow;
}

/// The function that a random number chooses, by its share, and what is left of the number.
PhaseLobe choosePhase(const Medium& m, double& u) {
    const std::vector<PhaseLobe> lobes = m.phases();
    size_t i = 0;
    for (; i + 1 < lobes.size() && u >= double(lobes[i].share); ++i)
        u -= double(lobes[i].share);
    u = std::min(u / double(lobes[i].share), 1 - 0x1p-53);
    return lobes[i];
}

} // namespace

double phaseDensity(const Medium& m, double cosine) {
    double sum = 0;
    for (const PhaseLobe& lobe : m.phases())
        sum += double(lobe.share) * phaseDensity(lobe, cosine);
    return sum;
}

double narrowPhaseDensity(const Medium& m, double cosine) {
    double sum = 0;
    for (const PhaseLobe& lobe : m.phases())
        if (isNarrow(lobe)) sum += double(lobe.share) * phaseDensity(lobe, cosine);
    return sum;
}

bool isNarrow(const Medium& m) {
    return std::ranges::all_of(m.phases(), [](const PhaseLobe& lobe) { return isNarrow(lobe); });
}

/// Henyey and Greenstein's distribution has an inverse; Rayleigh's is sampled by rejection folded
/// into one number: a mixture of a uniform cosine (3/4 of it) and one of density 3/2 cos^2.
glm::dvec3 samplePhase(const Medium& m, const glm::dvec3& forward, double u, double v) {
    const PhaseLobe lobe = choosePhase(m, u);
    double cosine = 1 - 2 * u;
    const double g = lobe.asymmetry;
    if (lobe.phase == PhaseFunction::Rayleigh) {
        cosine = u < 0.75 ? 1 - 2 * (u / 0.75) : std::cbrt(1 - 2 * ((u - 0.75) / 0.25));
    } else if (std::abs(g) > 1e-6) {
        const double s = (1 - g * g) / (1 - g + 2 * g * u);
        cosine = std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0);
    }
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    return Frame(forward).toWorld(
        {sine * std::cos(2 * kPi * v), sine * std::sin(2 * kPi * v), cosine});
}

} // namespace stromboli::reference

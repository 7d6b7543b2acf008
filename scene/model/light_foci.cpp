#include "scene/model/light_foci.hpp"

#include "host/core/color.hpp"
#include "scene/model/emitters.hpp"
#include "scene/model/mean_emission.hpp"
#include "scene/model/scene.hpp"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli {
namespace {

constexpr double kPi = glm::pi<double>();

/// The longest mean free path of media in which distances are drawn about lights.
double longestFreePath(const Scene& scene) {
    double longest = 0;
    for (const Medium& m : scene.media) {
        if (m.varies() || m.isUnderSurface || !m.scatters()) continue;
        const glm::dvec3 extinction(m.extinction());
        longest = std::max(longest, 3 / (extinction.x + extinction.y + extinction.z));
    }
    return longest;
}

LightFocus focusOf(const Scene& scene, const Emitter& e, const MeanEmission& means) {
    LightFocus focus;
    double area = 0;
    if (e.kind == EmitterKind::Sphere) {
        const Sphere& s = scene.spheres[e.sphere];
        focus.point = s.center;
        focus.radius = s.radius;
        focus.radiance = luminance(means.ofSphere(e.sphere));
        focus.intensity = focus.radiance * kPi * focus.radius * focus.radius;
        return focus;
    }
    Bounds bounds;
    for (const uint32_t triangle : e.triangles) {
        glm::dvec3 corner[3];
        for (size_t i = 0; i < 3; ++i) {
            const glm::vec3& p = scene.positions[scene.triangles[triangle].corner[i]];
            bounds.extend(p);
            corner[i] = p;
        }
        area += 0.5 * glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        // The power is pi times that.
        focus.intensity += means.powerOfTriangle(triangle) / 4;
    }
    const double sides = scene.materials[e.material].emitsBothSides ? 2 : 1;
    focus.point = 0.5 * (glm::dvec3(bounds.lo) + glm::dvec3(bounds.hi));
    focus.radius = 0.5 * glm::length(glm::dvec3(bounds.extent()));
    if (area > 0) focus.radiance = 4 * focus.intensity / (sides * area);
    return focus;
}

/// A light without a surface, which falls off with the squared distance.
LightFocus focusOf(const Light& l) {
    LightFocus focus;
    const double steep = l.quadraticAttenuation;
    focus.point = l.position;
    focus.radius = std::sqrt(double(l.constantAttenuation) / steep);
    focus.intensity = luminance(l.color) / steep;
    if (l.kind != LightKind::Point)
        focus.intensity *= 0.5 * (1 - std::cos(0.5 * double(l.falloffAngle)));
    return focus;
}

double meanLuminance(const Environment& e) {
    double sum = 0, weights = 0;
    for (uint32_t y = 0; y < e.height; ++y) {
        double row = 0;
        for (uint32_t x = 0; x < e.width; ++x)
            row += luminance(e.radiance[x + size_t(e.width) * y]);
        const double weight = e.rows().sineOf(y) * e.rows().partOf(y);
        sum += weight * row / e.width;
        weights += weight;
    }
    return e.strength * sum / weights;
}

/// size: how far apart lights and surfaces are, more or less.
double radianceOf(const Light& l, double size) {
    const double color = luminance(l.color);
    if (l.kind == LightKind::Ambient) return l.upperHemisphereOnly ? color / 2 : color;
    if (l.kind == LightKind::Directional) return color / kPi;
    if (l.kind == LightKind::Area) return 0; // is an emitter, or of conventions without media
    return color / kPi /
           (l.constantAttenuation + size * (l.linearAttenuation + size * l.quadraticAttenuation));
}

/// Lamps that a sphere of this radius holds are one: a share of the free path, or of the scene's
/// size.
constexpr double kTogether = 0.01;

/// Takes the second one into the first, if a sphere of that radius holds both.
bool join(LightFocus& a, const LightFocus& b, double radius) {
    const glm::dvec3 between = b.point - a.point;
    const double distance = glm::length(between);
    const double both = std::max({a.radius, b.radius, 0.5 * (distance + a.radius + b.radius)});
    if (both > radius) return false;
    if (both == b.radius)
        a.point = b.point;
    else if (both > a.radius)
        a.point += between * ((both - a.radius) / distance);
    a.radius = both;
    a.intensity += b.intensity;
    a.radiance = std::max(a.radiance, b.radiance);
    return true;
}

} // namespace

LightFoci lightFoci(const Scene& scene) {
    LightFoci foci;
    const double freePath = longestFreePath(scene);
    if (!(freePath > 0)) return foci;
    const Bounds bounds = scene.framed();
    const double extent = bounds.empty() ? 0 : 0.5 * glm::length(glm::dvec3(bounds.extent()));
    const double size = extent > 0 ? extent : 1;
    // Nearer to a lamp, the rounding of places counts.
    const double least = 0x1p-14 * size;
    std::vector<LightFocus> all;
    const auto addToOthers = [&](const LightFocus& focus) {
        foci.others += focus.intensity / (kPi * size * size);
    };
    const auto add = [&](LightFocus focus) {
        focus.radius = std::max(focus.radius, least);
        if (!(4 * kPi * focus.radius < freePath)) return addToOthers(focus);
        for (LightFocus& other : all)
            if (join(other, focus, kTogether * std::min(freePath, size))) return;
        all.push_back(focus);
    };
    for (const Light& l : scene.lights) {
        if (l.isLamp() && l.quadraticAttenuation > 0)
            add(focusOf(l));
        else
            foci.others += radianceOf(l, size);
    }
    if (scene.environment) foci.others += meanLuminance(*scene.environment);
    const MeanEmission means(scene);
    for (const Emitter& e : collectEmitters(scene))
        add(focusOf(scene, e, means));
    std::ranges::stable_sort(all, std::ranges::greater(), &LightFocus::intensity);
    for (size_t i = kMostFoci; i < all.size(); ++i)
        addToOthers(all[i]);
    all.resize(std::min(all.size(), kMostFoci));
    foci.near = std::move(all);
    return foci;
}

} // namespace stromboli

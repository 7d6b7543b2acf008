#include "scene/model/medium.hpp"

#include "scene/model/meet_triangle.hpp"
#include "scene/model/overlapping_volumes.hpp"
#include "scene/model/scene.hpp"
#include "scene/model/world_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

namespace stromboli {

glm::dvec3 GlowTable::at(double kelvins) const {
    if (!(kelvins >= double(coldest))) return glm::dvec3(0.0);
    const double first = 1 / double(coldest), last = 1 / double(hottest);
    const double most = double(values.size()) - 1;
    const double x = std::clamp((1 / kelvins - first) / (last - first), 0.0, 1.0) * most;
    const size_t low = std::min(size_t(x), values.size() - 2);
    const glm::dvec4 v =
        glm::mix(glm::dvec4(values[low]), glm::dvec4(values[low + 1]), x - double(low));
    return glm::dvec3(v) * std::exp(v.w);
}

namespace {

bool isSome(const glm::vec3& v) {
    return v.x > 0 || v.y > 0 || v.z > 0;
}

} // namespace

bool Medium::scatters() const {
    return colors.scattering ? isSome(colors.scattering->largest()) : isSome(scattering);
}

bool Medium::emits() const {
    return colors.source ? isSome(colors.source->largest()) : isSome(emission);
}

MediumPoint Medium::at(const glm::dvec3& world, const glm::dvec3& place) const {
    const glm::dvec3 whole(extinction());
    const double dense = density ? density->goingOn(place) : 1;
    MediumPoint p;
    p.extinction =
        whole * (colors.extinction ? colors.extinction->goingOn(place) : glm::dvec3(dense));
    for (int c = 0; c < 3; ++c)
        if (whole[c] > 0) p.scattering[c] = p.extinction[c] * double(scattering[c]) / whole[c];
    if (colors.scattering) {
        const glm::dvec3 found = colors.scattering->goingOn(colors.scattering->place(world));
        p.scattering =
            glm::min((colors.scatteringIsFactor ? whole : p.extinction) * found, p.extinction);
    }
    p.emission = glm::dvec3(emission) *
                 (colors.extinction ? colors.extinction->goingOn(place) : glm::dvec3(dense));
    if (colors.source) {
        glm::dvec3 light = colors.source->goingOn(colors.source->place(world));
        if (colors.glow) light = light.x * colors.glow->at(light.y);
        p.emission = (p.extinction - p.scattering) * light;
    }
    return p;
}

DensityGrid Medium::bound() const {
    if (!colors.extinction) return density.value();
    const glm::vec3 whole = extinction();
    const float most = std::max({whole.x, whole.y, whole.z});
    ColorGrid scaled = *colors.extinction;
    for (glm::vec3& value : scaled.values)
        value *= most > 0 ? whole / most : whole;
    return largestChannels(scaled);
}

std::vector<std::array<glm::dvec4, 3>*> Medium::places() {
    std::vector<std::array<glm::dvec4, 3>*> all;
    if (density) all.push_back(&density->toUnit);
    for (std::optional<ColorGrid>* grid : {&colors.extinction, &colors.scattering, &colors.source})
        if (*grid) all.push_back(&(*grid)->toUnit);
    return all;
}

std::vector<PhaseLobe> Medium::phases() const {
    std::vector<PhaseLobe> lobes{{phase, asymmetry, 1}};
    for (const PhaseLobe& other : otherPhases)
        lobes.front().share -= other.share;
    lobes.insert(lobes.end(), otherPhases.begin(), otherPhases.end());
    return lobes;
}

bool Medium::setPhases(std::vector<PhaseLobe> lobes) {
    std::vector<PhaseLobe> taken;
    for (const PhaseLobe& lobe : lobes) {
        if (!(lobe.share > 0 && std::isfinite(lobe.share))) continue;
        const auto isSame = [&](const PhaseLobe& t) {
            return t.phase == lobe.phase && t.asymmetry == lobe.asymmetry;
        };
        const auto same = std::ranges::find_if(taken, isSame);
        if (same == taken.end())
            taken.push_back(lobe);
        else
            same->share += lobe.share;
    }
    std::ranges::stable_sort(taken, std::greater(), &PhaseLobe::share);
    const bool isAll = taken.size() <= kMostPhases;
    taken.resize(std::min(taken.size(), kMostPhases));
    if (taken.empty()) taken.push_back({});
    float sum = 0;
    for (const PhaseLobe& lobe : taken)
        sum += lobe.share;
    for (PhaseLobe& lobe : taken)
        lobe.share = sum > 0 ? lobe.share / sum : 1;
    phase = taken.front().phase;
    asymmetry = taken.front().asymmetry;
    otherPhases.assign(taken.begin() + 1, taken.end());
    return isAll;
}

namespace {

/// The medium inside a material that states none: what it absorbs, if it does.
uint32_t mediumInside(Scene& scene, const Material& m) {
    if (m.kind != MaterialKind::Principled) return kNoMedium;
    Medium medium;
    medium.name = m.name;
    medium.absorption = m.principled.absorption();
    if (medium.absorption == glm::vec3(0)) return kNoMedium;
    scene.media.push_back(std::move(medium));
    return uint32_t(scene.media.size() - 1);
}

bool usesMedia(const Scene& scene) {
    const auto isThere = [](uint32_t medium) { return medium != kNoMedium; };
    return isThere(scene.surrounding) ||
           std::ranges::any_of(scene.cameras, isThere, &FileCamera::medium) ||
           std::ranges::any_of(scene.materials, isThere, &Material::inside) ||
           std::ranges::any_of(scene.materials, isThere, &Material::outside);
}

} // namespace

void resolveMedia(Scene& scene) {
    if (!usesMedia(scene)) {
        scene.media.clear();
        for (Material& m : scene.materials)
            m.boundsMedia = m.outsideIsOpen = false;
    }
    if (scene.media.empty()) return;
    for (Material& m : scene.materials) {
        if (m.boundsMedia || m.isNull() || !m.entersVolume()) continue;
        m.inside = mediumInside(scene, m);
        m.outside = scene.surrounding;
        m.boundsMedia = m.outsideIsOpen = true;
    }
    orderVolumes(scene);
}

namespace {

/// A ray, and what it has met so far: the first border of those that state both of their sides, and
/// how often it leaves each volume more than it enters it.
struct BorderSearch {
    glm::dvec3 origin, direction;
    bool seeksVolumes = false; ///< and no borders that state both sides
    double nearest = std::numeric_limits<double>::infinity();
    uint32_t medium = kNoMedium; ///< on this side of it
    std::map<uint32_t, int> left;

    void meet(double t, bool fromOutside, const Material& border) {
        if (border.outsideIsOpen != seeksVolumes || !(t > 0)) return;
        if (seeksVolumes) {
            left[border.inside] += fromOutside ? -1 : 1;
            return;
        }
        if (!(t < nearest)) return;
        nearest = t;
        medium = fromOutside ? border.outside : border.inside;
    }

    /// facing: 1, or -1 where the normal points to the other side.
    void triangle(const std::array<glm::dvec3, 3>& corners, double facing, const Material& border) {
        if (const auto met = meetTriangle(origin, direction, corners))
            meet(met->t, met->fromFront == (facing > 0), border);
    }

    void sphere(const Sphere& sphere, const Material& border) {
        const glm::dvec3 from = origin - glm::dvec3(sphere.center);
        const double a = glm::dot(direction, direction), b = glm::dot(from, direction);
        const double c = glm::dot(from, from) - double(sphere.radius) * double(sphere.radius);
        const double root = b * b - a * c;
        if (root < 0) return;
        meet((-b - std::sqrt(root)) / a, true, border);
        meet((-b + std::sqrt(root)) / a, false, border);
    }
};

bool isBorder(const Material& material) {
    return material.boundsMedia;
}

void searchBorders(const Scene& scene, BorderSearch& search) {
    forTrianglesInWorld(
        scene, isBorder,
        [&](const std::array<glm::dvec3, 3>& corners, double facing, uint32_t triangle, uint32_t) {
            search.triangle(corners, facing, scene.materials[scene.triangles[triangle].material]);
        });
    for (const Sphere& s : scene.spheres)
        if (isBorder(scene.materials[s.material])) search.sphere(s, scene.materials[s.material]);
}

/// The volume that counts, of those that may overlap and in which the place is.
std::optional<uint32_t> volumeAt(const Scene& scene, const glm::dvec3& place) {
    if (std::ranges::none_of(scene.materials, &Material::outsideIsOpen)) return std::nullopt;
    // A direction that no scene has: along a surface there would be nothing to meet.
    BorderSearch search{place, {0.35713, 0.48291, 0.79953}, true};
    searchBorders(scene, search);
    std::optional<uint32_t> last;
    for (const auto& [medium, count] : search.left)
        if (count > 0) last = medium;
    return last;
}

} // namespace

uint32_t mediumAt(const Scene& scene, const glm::dvec3& place) {
    if (scene.media.empty()) return kNoMedium;
    if (const std::optional<uint32_t> volume = volumeAt(scene, place)) return *volume;
    Bounds borders;
    forTrianglesInWorld(scene, isBorder,
                        [&](const std::array<glm::dvec3, 3>& corners, double, uint32_t, uint32_t) {
                            for (const glm::dvec3& corner : corners)
                                borders.extend(glm::vec3(corner));
                        });
    for (const Sphere& s : scene.spheres)
        if (isBorder(scene.materials[s.material])) {
            borders.extend(s.center - s.radius);
            borders.extend(s.center + s.radius);
        }
    if (borders.empty()) return scene.surrounding;
    BorderSearch search{place, 0.5 * (glm::dvec3(borders.lo) + glm::dvec3(borders.hi)) - place};
    if (search.direction == glm::dvec3(0)) search.direction = {0.36, 0.48, 0.8}; // any will do
    search.medium = scene.surrounding;
    searchBorders(scene, search);
    return search.medium;
}

} // namespace stromboli

#include "host/kernel/find_lit_cells.hpp"

#include "host/kernel/lamp_light.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "shaders/shared/bsdf_types.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

namespace stromboli {
namespace {

/// Rays of light that are traced; the first few tell whether it is worth to trace the others.
constexpr size_t kFirstRays = 1024, kRays = 8192;
/// A triangle is divided while a cell would have so many of them.
constexpr double kRaysOfCell = 16;
constexpr uint32_t kMostLevels = 6;
/// Bright is what is so many times as bright as what gets most of the light, which is so much.
constexpr double kBrightness = 4, kMostLight = 0.98;
/// Aiming pays where so much of all light lands first on what is bright, as in shades and housings
/// of lamps, and so much goes on from there to what is darker; or where so much does both by glass
/// about a lamp, where light samples find none of it (docs/results.md, "Aimed bounces").
constexpr double kLeastLanding = 0.5, kLeastGoingOn = 0.05, kLeastByGlass = 0.02;

// --- Light on its way ----------------------------------------------------------------------------

/// Where one ray of light has been.
struct TracedLight {
    Landed first;         ///< what bounces may aim at: where it has landed first
    Landed goesOn;        ///< where it goes on to from there
    bool byGlass = false; ///< `first` is where it has left the glass about its lamp
};

/// A ray from where light has landed, by a cosine: back, or on where the material lets light
/// through.
TraversalRay scattered(const GpuScene& scene, const Landed& landed, Random& random) {
    TraversalRay ray;
    const bool goesThrough =
        (materialAtPlace(scene, landed.place).closures & gpu::TRANSMISSION_LOBES) != 0 &&
        random.uniform() < 0.5f;
    const glm::dvec3 n = goesThrough ? -landed.normal : landed.normal;
    ray.direction = aboutNormal(n, random);
    ray.origin = glm::vec3(landed.point);
    ray.skipPrimitive = landed.place;
    // A sphere is met again from where it is left but for the rounding of the origin.
    if (!placedCorners(scene.bvh, landed.place))
        ray.origin = glm::vec3(landed.point + 0x1p-20 * glm::length(landed.point) * n);
    return ray;
}

std::vector<TracedLight> trace(const GpuScene& scene, std::span<const Lamp> lamps, size_t count,
                               Random& random) {
    const std::vector<TraversalRay> starts = raysOfLamps(lamps, count, random);
    std::vector<LightPath> paths(starts.size());
    tbb::parallel_for(size_t(0), starts.size(),
                      [&](size_t i) { paths[i] = followLight(scene, starts[i]); });
    std::vector<TracedLight> rays(starts.size());
    std::vector<TraversalRay> onwards(starts.size());
    for (size_t i = 0; i < paths.size(); ++i) {
        rays[i].byGlass = paths[i].glass.place != gpu::NO_PRIMITIVE;
        rays[i].first = rays[i].byGlass ? paths[i].glass : paths[i].surface;
        if (!rays[i].byGlass && rays[i].first.place != gpu::NO_PRIMITIVE)
            onwards[i] = scattered(scene, rays[i].first, random);
    }
    tbb::parallel_for(size_t(0), rays.size(), [&](size_t i) {
        if (rays[i].byGlass)
            rays[i].goesOn = paths[i].surface;
        else if (rays[i].first.place != gpu::NO_PRIMITIVE)
            rays[i].goesOn = followLight(scene, onwards[i]).surface;
    });
    return rays;
}

// --- Cells ---------------------------------------------------------------------------------------

/// The cells of one triangle: squares of its barycentric weights, of which the diagonal makes two.
/// Those of a sphere are all of it, and nothing.
struct Division {
    uint32_t level = 0;
    double area = 0; ///< of a cell
    bool isSphere = false;
    std::vector<double> light;

    uint32_t side() const { return 1u << level; }
    size_t cellOf(const Landed& l) const { return gpu::cellOfWeights(l.b1, l.b2, level); }
    double brightness(size_t cell) const { return light[cell] / area; }
};
using Divisions = std::map<uint32_t, Division>; ///< by place

Divisions divide(const WideLayout& bvh, std::span<const Landed> landed) {
    std::map<uint32_t, size_t> counts;
    for (const Landed& l : landed)
        if (l.place != gpu::NO_PRIMITIVE) ++counts[l.place];
    Divisions divisions;
    for (const auto& [place, count] : counts) {
        Division d;
        if (const std::optional<PlacedCorners> c = placedCorners(bvh, place)) {
            while (d.level < kMostLevels &&
                   double(count) >= kRaysOfCell * std::pow(4.0, d.level + 1))
                ++d.level;
            d.area = c->area() / double(d.side()) / double(d.side());
        } else {
            const double radius = placedSphere(bvh, place).radius;
            d.isSphere = true, d.area = 4 * std::numbers::pi * radius * radius;
        }
        d.light.assign(2 * size_t(d.side()) * d.side(), 0);
        divisions.emplace(place, std::move(d));
    }
    for (const Landed& l : landed)
        if (l.place != gpu::NO_PRIMITIVE) {
            Division& d = divisions.at(l.place);
            d.light[d.cellOf(l)] += 1;
        }
    return divisions;
}

/// How bright a surface is there; 0: no light has landed on it; -1: there is none.
double brightnessAt(const Divisions& divisions, const Landed& l) {
    if (l.place == gpu::NO_PRIMITIVE) return -1;
    const auto found = divisions.find(l.place);
    if (found == divisions.end()) return 0;
    return found->second.brightness(found->second.cellOf(l));
}

/// The mean brightness of the brightest cells that get kMostLight of the light. Without what is
/// dimmer, such as the ground before a window, it is that of a room.
double usualBrightness(const Divisions& divisions) {
    struct Cell {
        double light, area;
        double brightness() const { return light / area; }
    };
    std::vector<Cell> cells;
    double all = 0;
    for (const auto& [place, d] : divisions)
        for (const double light : d.light)
            if (light > 0) {
                cells.push_back({light, d.area});
                all += light;
            }
    std::ranges::sort(cells, std::greater<>(), &Cell::brightness);
    double light = 0, area = 0;
    for (const Cell& c : cells)
        if (light < kMostLight * all) light += c.light, area += c.area;
    return area > 0 ? light / area : 0;
}

/// What it pays to aim at; empty: nothing.
std::vector<Landed> worthAiming(const GpuScene& scene, std::span<const TracedLight> rays) {
    std::vector<Landed> first, behindGlass;
    for (const TracedLight& r : rays) {
        first.push_back(r.first);
        behindGlass.push_back(r.byGlass ? r.goesOn : r.first);
    }
    const Divisions aimedAt = divide(scene.bvh, first);
    const Divisions lit = divide(scene.bvh, behindGlass); // as the room is without glass
    const double limit = kBrightness * usualBrightness(lit);
    size_t lands = 0, goesOn = 0;
    std::vector<Landed> glass;
    for (const TracedLight& r : rays) {
        if (!(brightnessAt(aimedAt, r.first) > limit)) continue;
        const double to = brightnessAt(lit, r.goesOn);
        const bool darkens = to >= 0 && to <= limit;
        ++lands;
        if (darkens) ++goesOn;
        if (darkens && r.byGlass) glass.push_back(r.first);
    }
    const auto share = [&](size_t count) { return double(count) / double(rays.size()); };
    if (share(lands) >= kLeastLanding && share(goesOn) >= kLeastGoingOn) return first;
    return share(glass.size()) >= kLeastByGlass ? glass : std::vector<Landed>();
}

LitCells asTable(const Divisions& divisions, size_t places) {
    LitCells lit;
    lit.ofPlace.assign((places + 3) / 4 * 4, gpu::NO_CELLS);
    std::vector<double> light;
    for (const auto& [place, d] : divisions) {
        lit.ofPlace[place] = uint32_t(light.size()) << gpu::CELLS_LEVEL_BITS | d.level;
        light.insert(light.end(), d.light.begin(), d.light.end());
    }
    const std::vector<AliasColumn> columns = buildAliasTable(light);
    const double all = std::accumulate(light.begin(), light.end(), 0.0);
    for (const auto& [place, d] : divisions)
        for (const double x : d.light) {
            const AliasColumn& column = columns[lit.cells.size()];
            // Spheres are aimed at by solid angle.
            const double density = x / (d.isSphere ? 1 : d.area) / all;
            // In scenes so small or large that a float cannot hold the density nothing is aimed at.
            if (density > 0 && !std::isnormal(float(density))) return {};
            lit.cells.push_back({float(column.threshold), column.alias, place, float(density)});
        }
    return lit;
}

bool mayAim(const GpuScene& scene) {
    constexpr uint32_t kLamps =
        1u << gpu::LIGHT_QUAD | 1u << gpu::LIGHT_SPHERE | 1u << gpu::LIGHT_TRIANGLE;
    const LightTable& lights = scene.lights;
    return (lights.sampledKinds & ~kLamps) == 0 && !lights.hasAmbient && scene.gapWidth == 0 &&
           !scene.hasPlacements && scene.media == 0 && scene.mostOthers == 0;
}

} // namespace

LitCells findLitCells(const GpuScene& scene) {
    if (!mayAim(scene)) return {};
    const std::vector<Lamp> lamps = lampsOf(scene);
    if (lamps.empty()) return {};
    Random random(29);
    std::vector<Landed> targets;
    for (const size_t count : {kFirstRays, kRays}) {
        targets = worthAiming(scene, trace(scene, lamps, count, random));
        if (targets.empty()) return {};
    }
    return asTable(divide(scene.bvh, targets), 2 * scene.bvh.records.size());
}

std::vector<Row> litRows(const LitCells& lit) {
    std::vector<Row> rows;
    rows.reserve(lit.rowCount());
    for (const gpu::LitCell& cell : lit.cells)
        appendRows(rows, cell);
    for (size_t i = 0; i < lit.ofPlace.size(); i += 4)
        rows.push_back(
            {lit.ofPlace[i], lit.ofPlace[i + 1], lit.ofPlace[i + 2], lit.ofPlace[i + 3]});
    return rows;
}

} // namespace stromboli

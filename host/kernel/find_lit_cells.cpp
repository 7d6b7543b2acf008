#include "host/kernel/find_lit_cells.hpp"

#include "host/bvh/cpu_traversal.hpp"
#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"
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
constexpr size_t kFirstRays = 1024, kRays = 32768;
/// A triangle is divided while a cell would have so many of them.
constexpr double kRaysOfCell = 16;
constexpr uint32_t kMostLevels = 6;
/// Bright is what is so many times as bright as what gets most of the light, which is so much.
constexpr double kBrightness = 4, kMostLight = 0.98;
/// Aiming pays where so much of all light lands first on what is bright, as in shades and housings
/// of lamps, and so much goes on from there to what is darker (docs/results.md, "Aimed bounces").
constexpr double kLeastLanding = 0.5, kLeastGoingOn = 0.05;

// --- Lamps ---------------------------------------------------------------------------------------

/// What light starts from: a parallelogram, a triangle or a sphere.
struct Lamp {
    glm::dvec3 corner{0}, edgeA{0}, edgeB{0};
    double radius = 0; ///< of a sphere about `corner`; 0: it is none
    bool isTriangle = false, bothSides = false;
    double power = 0; ///< luminous, up to a factor that all lamps have
};

double meanOf(const glm::vec3& color) {
    return (double(color.x) + color.y + color.z) / 3;
}

struct Corners {
    glm::dvec3 v0, v1, v2;
    double area() const { return 0.5 * glm::length(glm::cross(v1 - v0, v2 - v0)); }
    glm::dvec3 normal() const { return glm::normalize(glm::cross(v1 - v0, v2 - v0)); }
};

/// Nothing of spheres.
std::optional<Corners> cornersOf(const WideLayout& bvh, uint32_t place) {
    TraversalHit hit;
    hit.primitive = place;
    const auto c = cornersAt(bvh, hit);
    if (!c) return std::nullopt;
    return Corners{(*c)[0], (*c)[1], (*c)[2]};
}

uint32_t lightOf(const WideLayout& bvh, uint32_t place) {
    const gpu::LeafRecord leaf = asLeaf(bvh.records[place / 2]);
    return place % 2 == 0 ? leaf.light0 : leaf.light1;
}

gpu::MaterialHeader materialAt(const GpuScene& scene, uint32_t place) {
    const gpu::LeafRecord leaf = asLeaf(scene.bvh.records[place / 2]);
    const uint32_t first = leaf.primitive & gpu::RECORD_INDEX_MASK;
    return materialHeader(scene, scene.primitives[first + place % 2]);
}

Lamp lampOfTriangle(const GpuScene& scene, uint32_t place) {
    Lamp lamp;
    const std::optional<Corners> c = cornersOf(scene.bvh, place);
    if (!c) return lamp;
    const gpu::MaterialHeader m = materialAt(scene, place);
    lamp.corner = c->v0, lamp.edgeA = c->v1 - c->v0, lamp.edgeB = c->v2 - c->v0;
    lamp.isTriangle = true;
    lamp.bothSides = (m.closures & gpu::MATERIAL_EMITS_BOTH_SIDES) != 0;
    lamp.power = meanOf(m.emission) * c->area() * (lamp.bothSides ? 2 : 1);
    return lamp;
}

Lamp lampOfRows(const LightTable& lights, uint32_t light) {
    const size_t row = size_t(gpu::LIGHT_ROWS) * light;
    const auto header = structureAt<gpu::LightHeader>(lights.lights, row);
    Lamp lamp;
    lamp.bothSides = (header.kind & gpu::LIGHT_BOTH_SIDES) != 0;
    if ((header.kind & gpu::LIGHT_KIND_MASK) == gpu::LIGHT_SPHERE) {
        const auto sphere = structureAt<gpu::SphereLight>(lights.lights, row + 1);
        lamp.corner = sphere.center, lamp.radius = sphere.radius;
        lamp.power = meanOf(header.color) * 4 * std::numbers::pi * lamp.radius * lamp.radius;
        return lamp;
    }
    const auto quad = structureAt<gpu::QuadLight>(lights.lights, row + 1);
    lamp.corner = quad.corner, lamp.edgeA = quad.edgeA, lamp.edgeB = quad.edgeB;
    lamp.power = meanOf(header.color) * quad.area * (lamp.bothSides ? 2 : 1);
    return lamp;
}

std::vector<Lamp> lampsOf(const GpuScene& scene) {
    std::vector<Lamp> lamps;
    for (uint32_t i = 0; i < scene.lights.count; ++i) {
        const uint32_t light = structureAt<gpu::LightEntry>(scene.lights.table, i).light;
        const bool isTriangle = (light & gpu::LIGHT_IS_TRIANGLE) != 0;
        const Lamp lamp = isTriangle ? lampOfTriangle(scene, light & ~gpu::LIGHT_IS_TRIANGLE)
                                     : lampOfRows(scene.lights, light);
        if (lamp.power > 0) lamps.push_back(lamp);
    }
    return lamps;
}

// --- Light on its way ----------------------------------------------------------------------------

/// A direction by the cosine about a unit vector.
glm::vec3 aboutNormal(const glm::dvec3& n, Random& random) {
    const glm::dvec3 d = n + glm::dvec3(random.direction());
    const double length = glm::length(d);
    return length > 1e-6 ? glm::vec3(d / length) : glm::vec3(n);
}

TraversalRay leave(const Lamp& lamp, Random& random) {
    TraversalRay ray;
    glm::dvec3 normal, from;
    if (lamp.radius > 0) {
        normal = glm::dvec3(random.direction());
        from = lamp.corner + lamp.radius * normal;
    } else {
        double u = random.uniform(), v = random.uniform();
        if (lamp.isTriangle && u + v > 1) u = 1 - u, v = 1 - v;
        from = lamp.corner + u * lamp.edgeA + v * lamp.edgeB;
        normal = glm::normalize(glm::cross(lamp.edgeA, lamp.edgeB));
        if (lamp.bothSides && random.uniform() < 0.5f) normal = -normal;
    }
    ray.direction = aboutNormal(normal, random);
    // Outside of the lamp, whatever the rounding of its corners and of the origin, of 2^-24 each.
    const double size = glm::length(from) + lamp.radius + glm::length(lamp.edgeA);
    ray.origin = glm::vec3(from + 0x1p-20 * size * normal);
    return ray;
}

/// Light that has landed on a triangle.
struct Landed {
    uint32_t place = gpu::NO_PRIMITIVE; ///< NO_PRIMITIVE: it has not, or on a lamp
    float b1 = 0, b2 = 0;
    glm::dvec3 point{0}, normal{0}; ///< unit, to where it comes from
};

std::vector<Landed> landing(const WideLayout& bvh, std::span<const TraversalRay> rays) {
    std::vector<Landed> landed(rays.size());
    tbb::parallel_for(size_t(0), rays.size(), [&](size_t i) {
        const TraversalHit hit = closestHit(bvh, rays[i]);
        if (!hit || lightOf(bvh, hit.primitive) != gpu::NO_LIGHT) return;
        const std::optional<Corners> c = cornersOf(bvh, hit.primitive);
        if (!c || !(c->area() > 0)) return;
        glm::dvec3 n = c->normal();
        if (glm::dot(n, glm::dvec3(rays[i].direction)) > 0) n = -n;
        const glm::dvec3 at =
            c->v0 + double(hit.b1) * (c->v1 - c->v0) + double(hit.b2) * (c->v2 - c->v0);
        landed[i] = {hit.primitive, hit.b1, hit.b2, at, n};
    });
    return landed;
}

/// As many rays of each lamp as it has of the power; each carries as much.
std::vector<TraversalRay> raysOfLamps(std::span<const Lamp> lamps, size_t count, Random& random) {
    double power = 0;
    for (const Lamp& lamp : lamps)
        power += lamp.power;
    std::vector<TraversalRay> rays;
    double due = 0;
    for (const Lamp& lamp : lamps)
        for (due += double(count) * lamp.power / power; due >= 1; --due)
            rays.push_back(leave(lamp, random));
    return rays;
}

/// A ray from where each has landed, by a cosine: back, or on where the material lets light
/// through.
std::vector<TraversalRay> raysFrom(const GpuScene& scene, std::span<const Landed> landed,
                                   Random& random) {
    std::vector<TraversalRay> rays(landed.size());
    for (size_t i = 0; i < landed.size(); ++i) {
        if (landed[i].place == gpu::NO_PRIMITIVE) {
            rays[i].direction = glm::vec3(0); // hits nothing
            continue;
        }
        const bool goesThrough =
            (materialAt(scene, landed[i].place).closures & gpu::TRANSMISSION_LOBES) != 0 &&
            random.uniform() < 0.5f;
        rays[i].direction = aboutNormal(goesThrough ? -landed[i].normal : landed[i].normal, random);
        rays[i].origin = glm::vec3(landed[i].point);
        rays[i].skipPrimitive = landed[i].place;
    }
    return rays;
}

// --- Cells ---------------------------------------------------------------------------------------

/// The cells of one triangle: squares of its barycentric weights, of which the diagonal makes two.
struct Division {
    uint32_t level = 0;
    double area = 0; ///< of a cell
    std::vector<double> light;

    uint32_t side() const { return 1u << level; }

    size_t cellOf(float b1, float b2) const {
        const float k = float(side()), most = k - 0x1p-12f * k;
        const float x = std::min(b1 * k, most), y = std::min(b2 * k, most);
        const auto i = uint32_t(x), j = uint32_t(y);
        const bool isUpper = (x - float(i)) + (y - float(j)) > 1;
        return 2 * (size_t(i) * side() + j) + (isUpper ? 1 : 0);
    }

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
        while (d.level < kMostLevels && double(count) >= kRaysOfCell * std::pow(4.0, d.level + 1))
            ++d.level;
        d.area = cornersOf(bvh, place)->area() / double(d.side()) / double(d.side());
        d.light.assign(2 * size_t(d.side()) * d.side(), 0);
        divisions.emplace(place, std::move(d));
    }
    for (const Landed& l : landed)
        if (l.place != gpu::NO_PRIMITIVE) {
            Division& d = divisions.at(l.place);
            d.light[d.cellOf(l.b1, l.b2)] += 1;
        }
    return divisions;
}

/// How bright a surface is there; 0: no light has landed on it; -1: there is none.
double brightnessAt(const Divisions& divisions, const Landed& l) {
    if (l.place == gpu::NO_PRIMITIVE) return -1;
    const auto found = divisions.find(l.place);
    if (found == divisions.end()) return 0;
    return found->second.brightness(found->second.cellOf(l.b1, l.b2));
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

/// Whether aiming pays. first: where light has landed; second: where it went on to.
bool gathers(const Divisions& divisions, std::span<const Landed> first,
             std::span<const Landed> second) {
    const double limit = kBrightness * usualBrightness(divisions);
    size_t lands = 0, goesOn = 0;
    for (size_t i = 0; i < first.size(); ++i) {
        if (!(brightnessAt(divisions, first[i]) > limit)) continue;
        ++lands;
        const double to = brightnessAt(divisions, second[i]);
        if (to >= 0 && to <= limit) ++goesOn;
    }
    return double(lands) >= kLeastLanding * double(first.size()) &&
           double(goesOn) >= kLeastGoingOn * double(first.size());
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
            const double density = x / d.area / all;
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
    return lights.count > 0 && (lights.sampledKinds & ~kLamps) == 0 && !lights.hasAmbient &&
           scene.gapWidth == 0 && scene.hasTriangles && !scene.hasPlacements && scene.media == 0 &&
           scene.mostOthers == 0;
}

} // namespace

LitCells findLitCells(const GpuScene& scene) {
    if (!mayAim(scene)) return {};
    const std::vector<Lamp> lamps = lampsOf(scene);
    if (lamps.empty()) return {};
    Random random(29);
    Divisions divisions;
    for (const size_t rays : {kFirstRays, kRays}) {
        const std::vector<Landed> first = landing(scene.bvh, raysOfLamps(lamps, rays, random));
        const std::vector<Landed> second = landing(scene.bvh, raysFrom(scene, first, random));
        divisions = divide(scene.bvh, first);
        if (!gathers(divisions, first, second)) return {};
    }
    return asTable(divisions, 2 * scene.bvh.records.size());
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

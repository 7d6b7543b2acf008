#include "host/kernel/find_occluders.hpp"

#include "host/kernel/certain_shadow.hpp"
#include "host/kernel/lamp_light.hpp"
#include "host/kernel/occluded_area.hpp"
#include "host/kernel/seen_places.hpp"
#include "host/kernel/sky_picture.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

namespace stromboli {
namespace {

/// Each rectangle stops such a share of the light samples at least.
constexpr double kLeastOfOne = 0.01;
/// To look at them all takes as long as it takes a ray to visit so many records of the tree, or
/// less (docs/results.md, "Occluders").
constexpr double kCostInRecords = 2.5;
/// Planes that are looked at, those that stop most.
constexpr size_t kMostWalls = 16;

// --- Light samples -------------------------------------------------------------------------------

/// The way of a light sample to its light.
struct LightWay {
    glm::dvec3 origin{0}, direction{0}; ///< unit
    double length = 0;
    TraversalHit met; ///< first
};

/// Draws the ways of light samples, more or less as kernels do.
class LightWays {
  public:
    explicit LightWays(const GpuScene& packed) : packed_(packed) {
        if (packed.lights.environment) sky_.emplace(*packed.lights.environment);
    }

    /// To a light by its number; nothing: to none that the place is lit by.
    std::optional<LightWay> draw(const Place& place, uint32_t number, Random& random) const {
        LightWay way;
        way.origin = place.point, way.length = double(kInfiniteDistance);
        if (number == packed_.lights.ambientNumber)
            way.direction = toSky(place, random);
        else if (const std::optional<LampPoint> end = endOn(place, number, random)) {
            way.direction = end->point - place.point;
            way.length = glm::length(way.direction);
            if (!(glm::dot(way.direction, end->normal) <= 0)) return std::nullopt;
            way.direction /= way.length;
        } else {
            way.direction = glm::dvec3(rowOf(number));
        }
        const double cosine = glm::dot(way.direction, place.normal);
        if (!(place.isLitFromBehind ? cosine != 0 : cosine > 0)) return std::nullopt;
        return way;
    }

  private:
    glm::dvec3 toSky(const Place& place, Random& random) const {
        const std::vector<Portal>& portals = packed_.portals.all;
        if (!portals.empty() && random.uniform() < float(packed_.portals.share)) {
            const auto n =
                std::min(size_t(random.uniform() * float(portals.size())), portals.size() - 1);
            const Portal& p = portals[n];
            const glm::dvec3 at(p.corner + random.uniform() * p.edgeA + random.uniform() * p.edgeB);
            return glm::normalize(at - place.point);
        }
        return sky_ ? sky_->sample(random) : glm::dvec3(aboutNormal(place.normal, random));
    }

    /// First of the parameters of a light without a surface: its place, or the way to it.
    glm::vec3 rowOf(uint32_t number) const {
        return structureAt<glm::vec4>(packed_.lights.lights, firstRow(number) + 1);
    }
    size_t firstRow(uint32_t number) const {
        const auto entry = structureAt<gpu::LightEntry>(packed_.lights.table, number);
        return size_t(gpu::LIGHT_ROWS) * entry.light;
    }

    /// A point of a light that is not infinitely far; without a surface it shines all around.
    std::optional<LampPoint> endOn(const Place& place, uint32_t number, Random& random) const {
        if (const std::optional<Lamp> lamp = lampOfLight(packed_, number)) {
            LampPoint at = pointOf(*lamp, random);
            const bool turns = lamp->radius > 0 || lamp->bothSides;
            if (turns && glm::dot(at.normal, place.point - at.point) < 0) {
                if (lamp->radius > 0) at.point = 2.0 * lamp->corner - at.point;
                at.normal = -at.normal;
            }
            return at;
        }
        const auto header = structureAt<gpu::LightHeader>(packed_.lights.lights, firstRow(number));
        if ((header.kind & gpu::LIGHT_KIND_MASK) == gpu::LIGHT_DIRECTIONAL) return std::nullopt;
        return LampPoint{glm::dvec3(rowOf(number)), glm::dvec3(0)};
    }

    const GpuScene& packed_;
    std::optional<SkyPicture> sky_;
};

std::vector<LightWay> lightWays(const Scene& scene, const GpuScene& packed, const Camera& camera) {
    /// Rays of the camera, squared, and bounces from where they end; light samples of each place.
    constexpr uint32_t kSide = 16, kOfPlace = 3;
    constexpr int kBounces = 2;
    Random random(53);
    const SceneRays rays(scene, packed, false);
    const LightWays ways(packed);
    std::vector<LightWay> drawn;
    std::vector<TraversalRay> starts;
    uint32_t next = 0;
    for (const Place& place : placesSeen(rays, packed, camera, kSide, random, kBounces))
        for (uint32_t i = 0; i < kOfPlace; ++i, next = (next + 1) % packed.lights.count)
            if (const auto way = ways.draw(place, next, random)) {
                const bool isBehind = glm::dot(way->direction, place.normal) < 0;
                starts.push_back(rays.leave(place.point, isBehind ? -place.normal : place.normal,
                                            way->direction, place.hit));
                starts.back().tMax = float(way->length * (1 - 0x1p-12));
                drawn.push_back(*way);
            }
    tbb::parallel_for(size_t(0), drawn.size(),
                      [&](size_t i) { drawn[i].met = closestHit(packed.bvh, starts[i]); });
    return drawn;
}

// --- Planes --------------------------------------------------------------------------------------

/// A plane that light samples have met, and what of it is opaque.
struct Wall {
    glm::dvec3 normal{0}, point{0};
    size_t met = 0;
    glm::dvec3 across{0}, along{0};
    std::vector<FlatTriangle> triangles;

    double heightOf(const glm::dvec3& p) const { return glm::dot(normal, p - point); }
    glm::dvec2 placeOf(const glm::dvec3& p) const {
        return {glm::dot(p - point, across), glm::dot(p - point, along)};
    }
    bool holds(const std::array<glm::dvec3, 3>& corners, double thickness) const {
        // Within a quarter of it, none is as far from the plane as a ray's origin has to be.
        return std::ranges::all_of(
            corners, [&](const auto& c) { return std::abs(heightOf(c)) <= 0.25 * thickness; });
    }
    /// Where a light sample crosses it, as the kernel has it (shaders/include/occluders.glsl).
    std::optional<glm::dvec2> crossedBy(const LightWay& way, double thickness) const {
        const double height = heightOf(way.origin), fall = glm::dot(normal, way.direction);
        const bool crosses = height * fall < 0 && std::abs(height) > thickness &&
                             std::abs(fall) * way.length > std::abs(height) + thickness;
        if (!crosses || std::abs(fall) < kLeastFall) return std::nullopt;
        return placeOf(way.origin - height / fall * way.direction);
    }
};

std::array<glm::dvec3, 3> cornersOf(const Scene& scene, const Triangle& t) {
    return {scene.positions[t.corner[0]], scene.positions[t.corner[1]],
            scene.positions[t.corner[2]]};
}

/// Large triangles first, whose planes are known best.
std::vector<Wall> wallsMet(const Scene& scene, const GpuScene& packed,
                           std::span<const LightWay> ways, double thickness) {
    constexpr size_t kMostKept = 128;
    struct Met {
        std::array<glm::dvec3, 3> corners;
        glm::dvec3 normal; ///< times twice the area
    };
    std::vector<Met> met;
    for (const LightWay& way : ways) {
        if (!way.met) continue;
        const Material& m = scene.materials[materialNumberAt(scene, packed.bvh, way.met.primitive)];
        const auto c = placedCorners(packed.bvh, way.met.primitive);
        if (c && isOpaque(m))
            met.push_back({{c->v0, c->v1, c->v2}, glm::cross(c->v1 - c->v0, c->v2 - c->v0)});
    }
    std::ranges::stable_sort(met, std::greater(),
                             [](const Met& m) { return glm::dot(m.normal, m.normal); });
    std::vector<Wall> walls;
    for (const Met& m : met) {
        const auto home = std::ranges::find_if(
            walls, [&](const Wall& p) { return p.holds(m.corners, thickness); });
        if (home != walls.end())
            ++home->met;
        else if (walls.size() < kMostKept && glm::length(m.normal) > 0)
            walls.push_back({glm::normalize(m.normal), m.corners[0], 1});
    }
    std::erase_if(walls,
                  [&](const Wall& w) { return double(w.met) < kLeastOfOne * double(ways.size()); });
    std::ranges::stable_sort(walls, std::greater(), &Wall::met);
    walls.resize(std::min(walls.size(), kMostWalls));
    return walls;
}

/// The opaque triangles of each plane, and axes along their edges.
void takeTriangles(const Scene& scene, double thickness, std::vector<Wall>& walls) {
    std::vector<bool> opaque;
    for (const Material& m : scene.materials)
        opaque.push_back(isOpaque(m));
    tbb::parallel_for(size_t(0), walls.size(), [&](size_t i) {
        Wall& wall = walls[i];
        std::vector<std::array<glm::dvec3, 3>> found;
        for (const Triangle& t : scene.triangles) {
            if (std::abs(wall.heightOf(scene.positions[t.corner[0]])) > thickness) continue;
            const std::array<glm::dvec3, 3> corners = cornersOf(scene, t);
            if (opaque[t.material] && wall.holds(corners, thickness)) found.push_back(corners);
        }
        wall.across = usualEdge(wall.normal, found);
        wall.along = glm::cross(wall.normal, wall.across);
        for (const auto& c : found)
            wall.triangles.push_back(
                FlatTriangle{{wall.placeOf(c[0]), wall.placeOf(c[1]), wall.placeOf(c[2])}});
    });
}

// --- Rectangles ----------------------------------------------------------------------------------

/// What of a plane is opaque, and where light samples cross it.
struct Crossed {
    OpaqueCells cells;
    std::vector<std::optional<size_t>> cellOf; ///< by light sample; none: it does not cross one
};

Crossed crossings(const Wall& wall, std::span<const LightWay> ways, double thickness) {
    std::vector<std::optional<glm::dvec2>> places;
    std::vector<glm::dvec2> crossed;
    for (const LightWay& way : ways) {
        places.push_back(wall.crossedBy(way, thickness));
        if (places.back()) crossed.push_back(*places.back());
    }
    Crossed c{OpaqueCells(wall.triangles, crossed), {}};
    for (const std::optional<glm::dvec2>& place : places)
        c.cellOf.push_back(place ? c.cells.cellAt(*place) : std::nullopt);
    return c;
}

/// The rectangle that stops most of the light samples that are left.
struct Best {
    size_t wall = 0;
    CellRectangle cells;
};

Best bestOf(std::span<const Crossed> crossed, const std::vector<bool>& isStopped) {
    Best best;
    for (size_t p = 0; p < crossed.size(); ++p) {
        std::vector<uint32_t> counts(kOpaqueSide * kOpaqueSide, 0);
        for (size_t i = 0; i < isStopped.size(); ++i)
            if (!isStopped[i] && crossed[p].cellOf[i]) ++counts[*crossed[p].cellOf[i]];
        const CellRectangle cells = crossed[p].cells.bestRectangle(counts);
        if (cells.count > best.cells.count) best = {p, cells};
    }
    return best;
}

Occluder occluderOf(const Wall& wall, const OpaqueCells& cells, const CellRectangle& r,
                    double margin) {
    const glm::dvec2 lo = cells.cornerOf(r.column, r.row) + margin;
    const glm::dvec2 hi = cells.cornerOf(r.column + r.columns, r.row + r.rows) - margin;
    const glm::dvec2 middle = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
    return {wall.point + middle.x * wall.across + middle.y * wall.along, wall.normal,
            half.x * wall.across, half.y * wall.along};
}

} // namespace

Occluders findOccluders(const Scene& scene, const GpuScene& packed, const Camera& camera,
                        double leastShare) {
    if (packed.hasPlacements || packed.media != 0 || packed.lights.count == 0) return {};
    Occluders found;
    found.thickness = certainThickness(scene);
    const std::vector<LightWay> ways = lightWays(scene, packed, camera);
    if (!(found.thickness > 0) || ways.empty()) return {};
    const double least = leastShare * double(ways.size());
    std::vector<Wall> walls = wallsMet(scene, packed, ways, found.thickness);
    size_t met = 0;
    for (const Wall& wall : walls)
        met += wall.met;
    if (double(met) < least) return {};
    takeTriangles(scene, found.thickness, walls);
    std::vector<Crossed> crossed(walls.size());
    tbb::parallel_for(size_t(0), walls.size(),
                      [&](size_t i) { crossed[i] = crossings(walls[i], ways, found.thickness); });
    // A ray that crosses the plane has gone this far aside within the thickness on both sides of
    // it, at most: so far from its rim it meets the triangles that a rectangle lies in.
    const double margin = 2 * found.thickness / kLeastFall;
    std::vector<bool> isStopped(ways.size(), false);
    size_t all = 0;
    while (found.all.size() < gpu::MOST_OCCLUDERS) {
        const Best best = bestOf(crossed, isStopped);
        if (double(best.cells.count) < kLeastOfOne * double(ways.size())) break;
        const Crossed& c = crossed[best.wall];
        found.all.push_back(occluderOf(walls[best.wall], c.cells, best.cells, margin));
        for (size_t i = 0; i < ways.size(); ++i)
            isStopped[i] = isStopped[i] || (c.cellOf[i] && best.cells.holds(*c.cellOf[i]));
        all += best.cells.count;
    }
    if (double(all) < least) return {};
    return found;
}

Occluders occludersThatPay(const Scene& scene, const GpuScene& packed, const Camera& camera) {
    if (!packed.ofRay.isKnown()) return {};
    return findOccluders(scene, packed, camera, kCostInRecords / packed.ofRay.records);
}

float leastFall(const Occluders& occluders) {
    const double heights = kLeastFall / occluders.thickness;
    return occluders.all.empty() ? 0.0f : float(heights * heights);
}

std::array<glm::vec4, gpu::OCCLUDER_ROWS * gpu::MOST_OCCLUDERS>
occluderRows(const Occluders& occluders) {
    std::array<glm::vec4, gpu::OCCLUDER_ROWS * gpu::MOST_OCCLUDERS> rows{};
    for (size_t i = 0; i < occluders.all.size(); ++i) {
        const Occluder& o = occluders.all[i];
        const auto row = [&](const glm::dvec3& d) { return glm::vec4(d, -glm::dot(d, o.middle)); };
        rows[gpu::OCCLUDER_ROWS * i] = row(o.normal / occluders.thickness);
        rows[gpu::OCCLUDER_ROWS * i + 1] = row(o.halfAcross / glm::dot(o.halfAcross, o.halfAcross));
        rows[gpu::OCCLUDER_ROWS * i + 2] = row(o.halfAlong / glm::dot(o.halfAlong, o.halfAlong));
    }
    return rows;
}

} // namespace stromboli

#include "host/kernel/cast_shadows.hpp"

#include "host/kernel/certain_shadow.hpp"
#include "host/kernel/seen_places.hpp"
#include "shaders/shared/render_types.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace stromboli {
namespace {

/// Where fewer of the places that face the sun are told to be in shadow, it does not pay: looking a
/// place up takes some 120 instructions, an eighth of a step of a ray.
constexpr double kLeastThatPays = 0.1;
/// Places left out on each side, as a few far ones would make all cells large: one in so many.
constexpr size_t kLeftOut = 64;

/// The way to the brightest light from one direction; none: there is no such light.
std::optional<glm::vec3> brightestSun(const GpuScene& packed) {
    std::optional<glm::vec3> towards;
    float most = 0;
    for (uint32_t number = 0; number < packed.lights.count; ++number) {
        const auto entry = structureAt<gpu::LightEntry>(packed.lights.table, number);
        const size_t row = size_t(gpu::LIGHT_ROWS) * entry.light;
        if (row >= packed.lights.lights.size()) continue; // a primitive
        const auto header = structureAt<gpu::LightHeader>(packed.lights.lights, row);
        if ((header.kind & gpu::LIGHT_KIND_MASK) != gpu::LIGHT_DIRECTIONAL) continue;
        const float brightness = glm::dot(glm::vec3(header.color), glm::vec3(1));
        if (brightness > most) {
            most = brightness;
            towards = glm::vec3(structureAt<glm::vec4>(packed.lights.lights, row + 1));
        }
    }
    return towards;
}

/// Points as a sun sees them: column and row of the map, and height towards the sun.
class SunView {
  public:
    /// Over most of these places.
    SunView(const glm::vec3& towards, std::span<const Place> places) : towards_(towards) {
        const glm::dvec3 axis =
            std::abs(towards_.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        axes_[0] = glm::normalize(glm::cross(towards_, axis));
        axes_[1] = glm::normalize(glm::cross(towards_, axes_[0]));
        for (size_t i = 0; i < 2; ++i) {
            std::vector<double> at;
            for (const Place& p : places)
                at.push_back(glm::dot(axes_[i], p.point));
            std::ranges::sort(at);
            const size_t left = at.size() / kLeftOut;
            const double lo = at[left], hi = at[at.size() - 1 - left];
            cell_[i] = (hi - lo) / gpu::SHADOW_MAP_SIDE;
            lo_[i] = lo;
        }
    }

    bool hasArea() const { return cell_[0] > 0 && cell_[1] > 0; }
    const glm::dvec3& towards() const { return towards_; }
    /// Of a length, in columns and rows.
    glm::dvec2 inCells(double length) const { return {length / cell_[0], length / cell_[1]}; }
    glm::dvec3 operator()(const glm::dvec3& p) const {
        return {(glm::dot(axes_[0], p) - lo_[0]) / cell_[0],
                (glm::dot(axes_[1], p) - lo_[1]) / cell_[1], glm::dot(towards_, p)};
    }
    glm::vec4 row(size_t i) const { return glm::vec4(axes_[i] / cell_[i], -lo_[i] / cell_[i]); }

  private:
    glm::dvec3 towards_;
    std::array<glm::dvec3, 2> axes_{};
    std::array<double, 2> lo_{}, cell_{};
};

/// Of each cell the height below which something shades all of it.
class Heights {
  public:
    Heights() : all_(size_t(gpu::SHADOW_MAP_SIDE) * gpu::SHADOW_MAP_SIDE / 4) {
        Row none;
        none.fill(std::bit_cast<uint32_t>(-std::numeric_limits<float>::max()));
        std::ranges::fill(all_, none);
    }

    void raise(size_t column, size_t row, double height) {
        const size_t cell = row * gpu::SHADOW_MAP_SIDE + column;
        uint32_t& word = all_[cell / 4][cell % 4];
        if (height > double(std::bit_cast<float>(word)))
            word = std::bit_cast<uint32_t>(below(height));
    }

    std::vector<Row> take() { return std::move(all_); }

  private:
    static float below(double height) {
        const auto rounded = float(height);
        return double(rounded) <= height
                   ? rounded
                   : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
    }

    std::vector<Row> all_;
};

/// Cells that lie within a triangle with all of their surroundings. corners: as the sun sees them.
/// around: of a cell's middle, what has to lie within; lowered: by so much is the triangle lower.
void shade(std::array<glm::dvec3, 3> c, const glm::dvec2& around, double lowered,
           Heights& heights) {
    const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x * b.y - a.y * b.x;
    };
    double area = cross(c[1] - c[0], c[2] - c[0]);
    if (area < 0) std::swap(c[1], c[2]), area = -area;
    const glm::dvec3 e1 = c[1] - c[0], e2 = c[2] - c[0];
    const glm::dvec2 slope((e1.z * e2.y - e2.z * e1.y) / area, (e1.x * e2.z - e2.x * e1.z) / area);
    lowered += std::abs(slope.x) * around.x + std::abs(slope.y) * around.y;
    const auto last = double(gpu::SHADOW_MAP_SIDE - 1);
    const double bottom = std::min({c[0].y, c[1].y, c[2].y}),
                 top = std::max({c[0].y, c[1].y, c[2].y});
    const double firstRow = std::max(std::ceil(bottom + around.y - 0.5), 0.0);
    const double lastRow = std::min(std::floor(top - around.y - 0.5), last);
    for (double row = firstRow; row <= lastRow; ++row) {
        double first = 0, end = last; // columns
        for (size_t i = 0; i < 3; ++i) {
            // The edge has its inside on the left: a x + b >= 0 for middles of cells.
            const glm::dvec2 from = c[i], edge = glm::dvec2(c[(i + 1) % 3]) - from;
            const double a = -edge.y;
            const double b = edge.x * (row + 0.5 - from.y) + edge.y * from.x -
                             std::abs(edge.y) * around.x - std::abs(edge.x) * around.y;
            if (a > 0) first = std::max(first, std::ceil(-b / a - 0.5));
            if (a < 0) end = std::min(end, std::floor(-b / a - 0.5));
            if (a == 0 && b < 0) end = -1;
        }
        const double here = c[0].z - lowered + slope.y * (row + 0.5 - c[0].y);
        for (double column = first; column <= end; ++column)
            heights.raise(size_t(column), size_t(row), here + slope.x * (column + 0.5 - c[0].x));
    }
}

/// Whether a triangle might hold a cell with its surroundings.
bool isLarge(const std::array<glm::dvec3, 3>& c, const glm::dvec2& around) {
    const auto [left, right] = std::minmax({c[0].x, c[1].x, c[2].x});
    const auto [below, above] = std::minmax({c[0].y, c[1].y, c[2].y});
    return right - left >= 2 * around.x && above - below >= 2 * around.y && right > 0 &&
           above > 0 && left < gpu::SHADOW_MAP_SIDE && below < gpu::SHADOW_MAP_SIDE;
}

std::vector<Row> shadowsOf(const Scene& scene, const SunView& view) {
    const double thickness = certainThickness(scene);
    const glm::dvec2 around = 0.5 + view.inCells(2 * thickness);
    std::vector<bool> opaque;
    for (const Material& m : scene.materials)
        opaque.push_back(isOpaque(m));
    std::vector<glm::dvec3> seen;
    seen.reserve(scene.positions.size());
    for (const glm::vec3& p : scene.positions)
        seen.push_back(view(glm::dvec3(p)));
    Heights heights;
    const std::span<const Triangle> all = scene.triangles;
    for (const Triangle& t : all.subspan(scene.firstInWorld())) {
        const std::array<glm::dvec3, 3> c = {seen[t.corner[0]], seen[t.corner[1]],
                                             seen[t.corner[2]]};
        if (!opaque[t.material] || !isLarge(c, around)) continue;
        const glm::dvec3 v0 = scene.positions[t.corner[0]];
        const glm::dvec3 normal = glm::cross(glm::dvec3(scene.positions[t.corner[1]]) - v0,
                                             glm::dvec3(scene.positions[t.corner[2]]) - v0);
        const double fall = std::abs(glm::dot(normal, view.towards())) / glm::length(normal);
        if (fall >= kLeastFall) shade(c, around, thickness / fall, heights);
    }
    return heights.take();
}

} // namespace

bool isInShadow(const ShadowMap& map, const glm::vec3& origin, const glm::vec3& direction) {
    const auto at = [&](const glm::vec4& row) { return glm::dot(glm::vec3(row), origin) + row.w; };
    const float x = at(map.across), y = at(map.along);
    const bool isWithin = std::min(x, y) >= 0 && std::max(x, y) < float(gpu::SHADOW_MAP_SIDE);
    if (!isWithin || direction != map.towards) return false;
    const size_t cell = size_t(y) * gpu::SHADOW_MAP_SIDE + size_t(x);
    return glm::dot(map.towards, origin) < std::bit_cast<float>(map.heights[cell / 4][cell % 4]);
}

std::optional<ShadowMap> castShadows(const Scene& scene, const GpuScene& packed,
                                     const Camera& camera, double leastShare) {
    /// Rays of the camera, squared, and bounces from where they end.
    constexpr uint32_t kSide = 16;
    constexpr int kBounces = 2;
    const std::optional<glm::vec3> towards = brightestSun(packed);
    if (!towards || packed.media != 0) return {};
    Random random(61);
    std::vector<Place> places =
        placesSeen(SceneRays(scene, packed, false), packed, camera, kSide, random, kBounces);
    std::erase_if(places, [&](const Place& p) {
        return !p.isLitFromBehind && !(glm::dot(p.normal, glm::dvec3(*towards)) > 0);
    });
    if (places.empty()) return {};
    const SunView view(*towards, places);
    if (!view.hasArea()) return {};
    ShadowMap map{*towards, view.row(0), view.row(1), shadowsOf(scene, view)};
    const auto dark = std::ranges::count_if(
        places, [&](const Place& p) { return isInShadow(map, glm::vec3(p.point), *towards); });
    if (double(dark) < leastShare * double(places.size())) return {};
    return map;
}

std::optional<ShadowMap> shadowsThatPay(const Scene& scene, const GpuScene& packed,
                                        const Camera& camera) {
    return castShadows(scene, packed, camera, kLeastThatPays);
}

} // namespace stromboli

#include "scene/model/overlapping_volumes.hpp"

#include "scene/model/scene.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace stromboli {
namespace {

/// As many as a byte tells apart, with 0 for none (shaders/shared/medium_types.h).
constexpr size_t kMostVolumes = 255;

/// The boxes of volumes, by object and material.
using Boxes = std::map<std::pair<uint32_t, uint32_t>, Bounds>;

glm::vec3 inWorld(const Placement& placement, const glm::vec3& p) {
    glm::vec3 world;
    for (int i = 0; i < 3; ++i) {
        const glm::vec4& row = placement.toWorld[size_t(i)];
        world[i] = glm::dot(glm::vec3(row), p) + row.w;
    }
    return world;
}

Boxes boxesOf(const Scene& scene) {
    Boxes boxes;
    const auto isOpen = [&](uint32_t material) { return scene.materials[material].outsideIsOpen; };
    for (size_t i = scene.firstInWorld(); i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        if (!isOpen(t.material)) continue;
        Bounds& box = boxes[{t.instance, t.material}];
        for (const uint32_t corner : t.corner)
            box.extend(scene.positions[corner]);
    }
    for (const Placement& placement : scene.placements) {
        const Prototype& prototype = scene.prototypes[placement.prototype];
        for (uint32_t i = 0; i < prototype.triangles; ++i) {
            const Triangle& t = scene.triangles[prototype.firstTriangle + i];
            if (!isOpen(t.material)) continue;
            Bounds& box = boxes[{placement.instance, t.material}];
            for (const uint32_t corner : t.corner)
                box.extend(inWorld(placement, scene.positions[corner]));
        }
    }
    for (const Sphere& s : scene.spheres) {
        if (!isOpen(s.material)) continue;
        Bounds& box = boxes[{s.instance, s.material}];
        box.extend(s.center - s.radius);
        box.extend(s.center + s.radius);
    }
    return boxes;
}

bool anyOverlap(const Boxes& boxes) {
    std::vector<Bounds> sorted;
    for (const auto& [key, box] : boxes)
        sorted.push_back(box);
    std::ranges::sort(sorted, {}, [](const Bounds& b) { return b.lo.x; });
    for (size_t i = 0; i < sorted.size(); ++i)
        for (size_t k = i + 1; k < sorted.size() && sorted[k].lo.x <= sorted[i].hi.x; ++k)
            if (glm::all(glm::lessThanEqual(sorted[i].lo, sorted[k].hi)) &&
                glm::all(glm::lessThanEqual(sorted[k].lo, sorted[i].hi)))
                return true;
    return false;
}

/// The volume of the smallest box of each material.
std::vector<double> sizesOf(const Scene& scene, const Boxes& boxes) {
    std::vector<double> sizes(scene.materials.size(), std::numeric_limits<double>::infinity());
    for (const auto& [key, box] : boxes) {
        const glm::dvec3 extent(box.extent());
        double& size = sizes[key.second];
        size = std::min(size, extent.x * extent.y * extent.z);
    }
    return sizes;
}

/// order: the numbers of all media as they are to be.
void reorderMedia(Scene& scene, const std::vector<uint32_t>& order) {
    std::vector<Medium> media;
    std::vector<uint32_t> place(order.size());
    for (const uint32_t medium : order) {
        place[medium] = uint32_t(media.size());
        media.push_back(std::move(scene.media[medium]));
    }
    scene.media = std::move(media);
    const auto move = [&](uint32_t& medium) {
        if (medium != kNoMedium) medium = place[medium];
    };
    move(scene.surrounding);
    for (FileCamera& camera : scene.cameras)
        move(camera.medium);
    for (Material& m : scene.materials)
        move(m.inside), move(m.outside);
}

} // namespace

void orderVolumes(Scene& scene) {
    std::vector<uint32_t> volumes; // materials
    for (uint32_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].outsideIsOpen) volumes.push_back(i);
    const Boxes boxes = boxesOf(scene);
    const bool mayOverlap = anyOverlap(boxes);
    if (mayOverlap && volumes.size() > kMostVolumes)
        scene.report.warnings.emplace_back(
            "more than 255 kinds of volumes: where some overlap, what is behind the border that "
            "was passed last counts");
    if (!mayOverlap || volumes.size() > kMostVolumes) {
        for (const uint32_t i : volumes)
            scene.materials[i].outsideIsOpen = false;
        return;
    }
    const std::vector<double> sizes = sizesOf(scene, boxes);
    std::ranges::stable_sort(volumes, [&](uint32_t a, uint32_t b) { return sizes[a] > sizes[b]; });
    std::vector<uint32_t> order;
    for (const uint32_t i : volumes) {
        Material& m = scene.materials[i];
        // Each has one of its own, whose place says how much it counts.
        const bool isClear = m.inside == kNoMedium;
        const bool isTaken = !isClear && std::ranges::find(order, m.inside) != order.end();
        if (isClear || isTaken) {
            Medium own = isClear ? Medium() : scene.media[m.inside];
            if (isClear) own.name = m.name;
            m.inside = uint32_t(scene.media.size());
            scene.media.push_back(std::move(own));
        }
        order.push_back(m.inside);
    }
    for (uint32_t i = 0; i < scene.media.size(); ++i)
        if (std::ranges::find(order, i) == order.end()) order.push_back(i);
    reorderMedia(scene, order);
}

} // namespace stromboli

#include "scene/model/overlapping_volumes.hpp"

#include "scene/model/scene.hpp"
#include "scene/model/world_triangles.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace stromboli {
namespace {

/// As many as a byte tells apart, with 0 for none (shaders/shared/medium_types.h).
constexpr size_t kMostVolumes = 255;

/// Boxes of borders: by object and material of volumes, by the media on both sides of borders that
/// state both, which may be a region's only together.
using Boxes = std::map<std::pair<uint32_t, uint32_t>, Bounds>;

/// isOpen: of volumes; else of borders that state both sides.
Boxes boxesOf(const Scene& scene, bool isOpen) {
    Boxes boxes;
    const auto isWanted = [&](const Material& m) {
        return m.boundsMedia && m.outsideIsOpen == isOpen;
    };
    const auto boxOf = [&](uint32_t instance, uint32_t material) -> Bounds& {
        const Material& m = scene.materials[material];
        return boxes[isOpen ? std::pair(instance, material) : std::pair(m.inside, m.outside)];
    };
    forTrianglesInWorld(scene, isWanted,
                        [&](const std::array<glm::dvec3, 3>& corners, double, uint32_t triangle,
                            uint32_t instance) {
                            Bounds& box = boxOf(instance, scene.triangles[triangle].material);
                            for (const glm::dvec3& corner : corners)
                                box.extend(glm::vec3(corner));
                        });
    for (const Sphere& s : scene.spheres) {
        if (!isWanted(scene.materials[s.material])) continue;
        Bounds& box = boxOf(s.instance, s.material);
        box.extend(s.center - s.radius);
        box.extend(s.center + s.radius);
    }
    return boxes;
}

/// Whether two boxes of volumes overlap, or one of them and one of the others.
bool anyOverlap(const Boxes& volumes, const Boxes& others) {
    struct Box {
        Bounds bounds;
        bool isOfVolume;
    };
    std::vector<Box> sorted;
    for (const auto& [key, box] : volumes)
        sorted.push_back({box, true});
    for (const auto& [key, box] : others)
        sorted.push_back({box, false});
    std::ranges::sort(sorted, {}, [](const Box& b) { return b.bounds.lo.x; });
    for (size_t i = 0; i < sorted.size(); ++i) {
        const auto& [a, isOfVolume] = sorted[i];
        for (size_t k = i + 1; k < sorted.size() && sorted[k].bounds.lo.x <= a.hi.x; ++k) {
            const Bounds& b = sorted[k].bounds;
            if ((isOfVolume || sorted[k].isOfVolume) && glm::all(glm::lessThanEqual(a.lo, b.hi)) &&
                glm::all(glm::lessThanEqual(b.lo, a.hi)))
                return true;
        }
    }
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
    if (volumes.empty()) return;
    const Boxes boxes = boxesOf(scene, true);
    const bool mayOverlap = anyOverlap(boxes, boxesOf(scene, false));
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

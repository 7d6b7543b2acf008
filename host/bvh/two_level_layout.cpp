#include "host/bvh/two_level_layout.hpp"

#include "host/bvh/layout_writer.hpp"
#include "host/bvh/leaf_items.hpp"
#include "host/core/error.hpp"
#include "scene/model/placements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::bvh {
namespace {

/// Some of a scene's triangles as a scene of their own, with the positions that they use.
Scene partOf(const Scene& scene, uint32_t first, uint32_t end) {
    Scene part;
    if (first == end) return part;
    part.triangles.assign(scene.triangles.begin() + first, scene.triangles.begin() + end);
    // A mesh uses a run of positions; numbers within it need no table over all of the scene's.
    uint32_t least = std::numeric_limits<uint32_t>::max(), most = 0;
    for (const Triangle& t : part.triangles)
        for (const uint32_t corner : t.corner)
            least = std::min(least, corner), most = std::max(most, corner);
    part.positions.assign(scene.positions.begin() + least, scene.positions.begin() + most + 1);
    for (Triangle& t : part.triangles)
        for (uint32_t& corner : t.corner)
            corner -= least;
    return part;
}

/// A prototype's tree, and boxes that together hold it: of nodes a few levels down, which are
/// tighter in the world than the box of all.
struct BuiltPrototype {
    WideLayout layout;
    std::vector<Bounds> boxes;
};

constexpr uint32_t kBoxLevels = 6;

void collectBoxes(const BinaryTree& tree, uint32_t node, uint32_t levels,
                  std::vector<Bounds>& boxes) {
    const BinaryNode& n = tree.nodes[node];
    if (levels == 0 || n.isLeaf()) return boxes.push_back(n.bounds);
    collectBoxes(tree, n.left, levels - 1, boxes);
    collectBoxes(tree, n.right, levels - 1, boxes);
}

BuiltPrototype buildPrototype(const Scene& scene, const Prototype& prototype,
                              const BuildOptions& options) {
    const Scene part =
        partOf(scene, prototype.firstTriangle, prototype.firstTriangle + prototype.triangles);
    const std::vector<LeafItem> items = makeLeafItems(part);
    const BinaryTree tree = buildBinaryTree(itemBounds(part, items), options);
    BuiltPrototype built{writeLayout(part, items, tree), {}};
    if (!tree.nodes.empty()) collectBoxes(tree, 0, kBoxLevels, built.boxes);
    return built;
}

/// By how much rays may stray in the prototype's space (docs/numerics.md, "Instances"): in units of
/// u, the sums of |B| times 15 of the ray's origin, 35 of the prototype's reach E, and 1 of where
/// it is, m; as 16 times the first, 36 / 16 of the second and 1 / 16 of the third. A little more
/// covers the rounding of all this.
constexpr double kRounding = 16 * 0x1p-24, kMore = 1 + 0x1p-20;

float slackPerLength(const PlacementMatrices& m, int row) {
    double sum = 0;
    for (int column = 0; column < 3; ++column)
        sum += std::abs(m.inverseLinear[column][row]);
    return float(kRounding * sum * kMore);
}

gpu::TransformRecord transformRecord(const Placement& placement, const PlacementMatrices& m,
                                     const Bounds& box) {
    const glm::dvec3 largest = glm::max(glm::abs(glm::dvec3(box.lo)), glm::abs(glm::dvec3(box.hi)));
    double extent = 0, place = 0;
    for (int row = 0; row < 3; ++row) {
        double sum = 0;
        for (int column = 0; column < 3; ++column)
            sum += std::abs(m.linear[column][row]) * largest[column];
        extent = std::max(extent, sum);
        place = std::max(place, std::abs(m.offset[row]));
    }
    const auto reach = float((extent * 36 / 16 + place / 16) * kMore);
    return {placement.toWorld[0], placement.toWorld[1], placement.toWorld[2], reach, 0, 0, 0};
}

/// Adds one tree after the other to a layout that has that of the world.
class Assembly {
  public:
    Assembly(const Scene& scene, WideLayout world) : scene_(scene), layout_(std::move(world)) {
        toSceneNumbers();
    }

    /// Returns the record of its root. first: of its triangles in the scene.
    uint32_t append(const WideLayout& tree, uint32_t first) {
        const auto base = uint32_t(layout_.records.size());
        const auto entries = uint32_t(layout_.primitiveOrder.size());
        checkSize(layout_.records.size() + tree.records.size());
        for (Record record : tree.records) {
            if (isNode(record)) {
                gpu::NodeRecord node = asNode(record);
                node.firstChild += base;
                record = std::bit_cast<Record>(node);
            } else {
                gpu::LeafRecord leaf = asLeaf(record);
                leaf.primitive += entries;
                record = std::bit_cast<Record>(leaf);
            }
            layout_.records.push_back(record);
        }
        for (const uint32_t triangle : tree.primitiveOrder)
            layout_.primitiveOrder.push_back(first + triangle);
        for (uint32_t i = 0; i < tree.placeOf.size(); ++i) {
            layout_.placeOf[first + i] = 2 * base + tree.placeOf[i];
            layout_.firstCorner[first + i] = tree.firstCorner[i];
        }
        levels_ = std::max(levels_, tree.stackSize);
        return base;
    }

    void place(uint32_t number, uint32_t root, const Bounds& box) {
        const Placement& placement = scene_.placements[number];
        const PlacementMatrices m = matricesOf(placement);
        const auto record = uint32_t(layout_.records.size());
        layout_.records.push_back(std::bit_cast<Record>(transformRecord(placement, m, box)));
        gpu::PlacementRecord p{root,
                               record,
                               number | (m.mirrors ? gpu::PLACEMENT_MIRRORS : 0u),
                               gpu::RECORD_IS_PLACEMENT,
                               {},
                               {},
                               {}};
        glm::vec4* rows[3] = {&p.toPrototype0, &p.toPrototype1, &p.toPrototype2};
        for (int row = 0; row < 3; ++row)
            *rows[row] = {m.inverseLinear[0][row], m.inverseLinear[1][row], m.inverseLinear[2][row],
                          slackPerLength(m, row)};
        layout_.records[layout_.recordOfPlacement[number]] = std::bit_cast<Record>(p);
    }

    WideLayout finish() {
        checkSize(layout_.records.size());
        // While a ray is in a prototype, all that waits for it in the world waits beneath.
        layout_.stackSize += levels_;
        return std::move(layout_);
    }

  private:
    /// The world's tree was built over a part of the scene: its triangles, then the spheres.
    void toSceneNumbers() {
        const uint32_t first = scene_.firstInWorld();
        for (uint32_t& primitive : layout_.primitiveOrder)
            primitive += first;
        layout_.placeOf.insert(layout_.placeOf.begin(), first, 0);
        layout_.firstCorner.insert(layout_.firstCorner.begin(), first, 0);
    }

    static void checkSize(size_t records) {
        if (records > gpu::MAX_RECORDS)
            throw SceneError(
                fmt::format("BVH: {} records, expected at most {}", records, gpu::MAX_RECORDS));
    }

    const Scene& scene_;
    WideLayout layout_;
    uint32_t levels_ = 0;
};

Bounds boundsInWorld(const Placement& placement, std::span<const Bounds> boxes) {
    Bounds all;
    for (const Bounds& box : boxes)
        all.extend(stromboli::boundsInWorld(placement, box));
    return all;
}

} // namespace

WideLayout buildTwoLevels(const Scene& scene, const BuildOptions& options) {
    std::vector<BuiltPrototype> prototypes;
    for (const Prototype& p : scene.prototypes)
        prototypes.push_back(buildPrototype(scene, p, options));

    Scene world = partOf(scene, scene.firstInWorld(), uint32_t(scene.triangles.size()));
    world.spheres = scene.spheres;
    world.placements = scene.placements;
    std::vector<LeafItem> items = makeLeafItems(world);
    std::vector<Bounds> bounds = itemBounds(world, items);
    for (uint32_t i = 0; i < scene.placements.size(); ++i) {
        const Placement& p = scene.placements[i];
        if (prototypes[p.prototype].boxes.empty()) continue;
        LeafItem item;
        item.placement = i;
        items.push_back(item);
        bounds.push_back(boundsInWorld(p, prototypes[p.prototype].boxes));
    }

    Assembly assembly(scene, writeLayout(world, items, buildBinaryTree(bounds, options)));
    std::vector<uint32_t> roots;
    for (size_t i = 0; i < prototypes.size(); ++i) {
        roots.push_back(assembly.append(prototypes[i].layout, scene.prototypes[i].firstTriangle));
        prototypes[i].layout = {}; // its memory is of use to the next
    }
    const std::vector<Bounds> boxes = prototypeBounds(scene);
    for (uint32_t i = 0; i < scene.placements.size(); ++i) {
        const uint32_t prototype = scene.placements[i].prototype;
        if (!prototypes[prototype].boxes.empty())
            assembly.place(i, roots[prototype], boxes[prototype]);
    }
    return assembly.finish();
}

} // namespace stromboli::bvh

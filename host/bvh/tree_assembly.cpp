#include "host/bvh/tree_assembly.hpp"

#include "host/core/error.hpp"
#include "scene/model/placements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::bvh {
namespace {

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

void checkSize(size_t records) {
    if (records > gpu::MAX_RECORDS)
        throw SceneError(
            fmt::format("BVH: {} records, expected at most {}", records, gpu::MAX_RECORDS));
}

/// A record of a tree that begins at record `base`, and whose leaves begin at `entry` in the
/// Primitive buffer.
Record moved(const Record& record, uint32_t base, uint32_t entry) {
    if (isNode(record)) {
        gpu::NodeRecord node = asNode(record);
        node.firstChild += base;
        return std::bit_cast<Record>(node);
    }
    gpu::LeafRecord leaf = asLeaf(record);
    leaf.primitive += entry;
    return std::bit_cast<Record>(leaf);
}

} // namespace

TreeAssembly::TreeAssembly(const Scene& scene, WideLayout world,
                           std::span<const uint32_t> primitiveOf)
    : scene_(scene), layout_(std::move(world)) {
    const std::vector<uint32_t> placeOf = std::move(layout_.placeOf);
    const std::vector<uint8_t> firstCorner = std::move(layout_.firstCorner);
    layout_.placeOf.assign(scene.triangles.size() + scene.spheres.size(), 0);
    layout_.firstCorner.assign(layout_.placeOf.size(), 0);
    for (uint32_t& primitive : layout_.primitiveOrder)
        primitive = primitiveOf[primitive];
    for (size_t i = 0; i < placeOf.size(); ++i) {
        layout_.placeOf[primitiveOf[i]] = placeOf[i];
        layout_.firstCorner[primitiveOf[i]] = firstCorner[i];
    }
}

uint32_t TreeAssembly::append(const WideLayout& tree, std::span<const uint32_t> primitiveOf) {
    const auto base = uint32_t(layout_.records.size());
    const auto entry = uint32_t(layout_.primitiveOrder.size());
    checkSize(layout_.records.size() + tree.records.size());
    for (const Record& record : tree.records)
        layout_.records.push_back(moved(record, base, entry));
    for (const uint32_t primitive : tree.primitiveOrder)
        layout_.primitiveOrder.push_back(primitiveOf[primitive]);
    for (size_t i = 0; i < tree.placeOf.size(); ++i) {
        layout_.placeOf[primitiveOf[i]] = 2 * base + tree.placeOf[i];
        layout_.firstCorner[primitiveOf[i]] = tree.firstCorner[i];
    }
    levels_ = std::max(levels_, tree.stackSize);
    return base;
}

void TreeAssembly::place(uint32_t number, uint32_t root, const Bounds& box) {
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

void TreeAssembly::join(uint32_t placement, uint32_t root) {
    layout_.records[layout_.recordOfPlacement[placement]] = layout_.records[root];
}

WideLayout TreeAssembly::finish() {
    checkSize(layout_.records.size());
    layout_.recordOfPlacement.resize(scene_.placements.size());
    // While a ray is in an appended tree, all that waits for it in the world waits beneath.
    layout_.stackSize += levels_;
    return std::move(layout_);
}

} // namespace stromboli::bvh

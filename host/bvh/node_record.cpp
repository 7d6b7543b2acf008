#include "host/bvh/node_record.hpp"

#include "host/bvh/box_grid.hpp"

#include <algorithm>

namespace stromboli::bvh {

namespace {

constexpr double kPaddingOfScene = 0x1p-32; // of its largest coordinate
constexpr double kPaddingOfChild = 0x1p-21; // of its largest extent

struct Interval {
    double low, high;
};

Interval padded(const Bounds& box, int axis, double padding) {
    const glm::dvec3 extent = glm::dvec3(box.hi) - glm::dvec3(box.lo);
    const double largest = std::max(extent.x, std::max(extent.y, extent.z));
    const double pad = padding + kPaddingOfChild * largest;
    return {double(box.lo[axis]) - pad, double(box.hi[axis]) + pad};
}

/// The planes of an axis: the low and then the high ones, four to a word.
struct AxisPlanes {
    uint32_t gridWord = 0;
    uint32_t low[2] = {0, 0}, high[2] = {0, 0};
};

AxisPlanes packAxis(const ChildBoxes& children, int axis, double padding) {
    std::optional<Interval> all;
    for (const auto& child : children)
        if (child) {
            const Interval i = padded(*child, axis, padding);
            all = all ? Interval{std::min(all->low, i.low), std::max(all->high, i.high)} : i;
        }
    const AxisGrid grid = all ? gridOver(all->low, all->high) : AxisGrid{};
    AxisPlanes planes;
    planes.gridWord = grid.word();
    for (size_t slot = 0; slot < children.size(); ++slot) {
        uint32_t low = 255, high = 0; // absent
        if (children[slot]) {
            const Interval i = padded(*children[slot], axis, padding);
            low = planeBelow(grid, i.low);
            high = planeAbove(grid, i.high);
        }
        planes.low[slot / 4] |= low << (8 * (slot % 4));
        planes.high[slot / 4] |= high << (8 * (slot % 4));
    }
    return planes;
}

} // namespace

double boxPadding(const Bounds& scene) {
    double largest = 0;
    if (!scene.empty())
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max(largest, double(std::max(-scene.lo[axis], scene.hi[axis])));
    return kPaddingOfScene * largest;
}

gpu::NodeRecord packNode(const ChildBoxes& children, uint32_t firstChild, double padding) {
    const AxisPlanes x = packAxis(children, 0, padding), y = packAxis(children, 1, padding),
                     z = packAxis(children, 2, padding);
    return {x.gridWord, y.gridWord, z.gridWord, gpu::RECORD_IS_NODE | firstChild,
            x.low[0],   x.low[1],   x.high[0],  x.high[1],
            y.low[0],   y.low[1],   y.high[0],  y.high[1],
            z.low[0],   z.low[1],   z.high[0],  z.high[1]};
}

GridBox childBox(const gpu::NodeRecord& node, uint32_t slot) {
    const uint32_t words[3][5] = {
        {node.originAndExponentX, node.lowX0, node.lowX1, node.highX0, node.highX1},
        {node.originAndExponentY, node.lowY0, node.lowY1, node.highY0, node.highY1},
        {node.originAndExponentZ, node.lowZ0, node.lowZ1, node.highZ0, node.highZ1}};
    GridBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const AxisGrid grid = AxisGrid::fromWord(words[axis][0]);
        const auto plane = [&](size_t word) {
            return double(words[axis][word + slot / 4] >> (8 * (slot % 4)) & 255u);
        };
        box.lo[axis] = double(grid.origin) + plane(1) * grid.cell();
        box.hi[axis] = double(grid.origin) + plane(3) * grid.cell();
    }
    return box;
}

uint32_t firstChild(const gpu::NodeRecord& node) {
    return node.firstChild & gpu::RECORD_INDEX_MASK;
}

} // namespace stromboli::bvh

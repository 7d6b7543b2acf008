#include "host/bvh/statistics.hpp"

namespace stromboli {

double sahCost(const BinaryTree& tree, const BuildOptions& options) {
    const double rootArea = tree.nodes.front().bounds.halfArea();
    if (rootArea == 0) return 0;
    double cost = 0;
    for (const BinaryNode& node : tree.nodes) {
        const double ofNode =
            node.count == 0 ? options.traversalCost : double(node.count) * options.intersectionCost;
        cost += ofNode * (node.bounds.halfArea() / rootArea);
    }
    return cost;
}

BvhStatistics measure(const BinaryTree& tree, const BinaryLayout& layout,
                      const BuildOptions& options) {
    BvhStatistics s;
    s.nodes = uint32_t(tree.nodes.size());
    s.depth = tree.depth;
    s.sahCost = sahCost(tree, options);
    s.layoutBytes = layout.nodes.size() * sizeof layout.nodes[0] +
                    layout.primitiveOrder.size() * sizeof layout.primitiveOrder[0];
    // The one node of a tree without primitives is a leaf although its count is 0.
    const bool rootIsLeaf = tree.nodes.size() == 1;
    for (const BinaryNode& node : tree.nodes)
        if (node.count > 0 || rootIsLeaf) {
            ++s.leaves;
            ++s.leavesOfSize.at(node.count);
        }
    return s;
}

} // namespace stromboli

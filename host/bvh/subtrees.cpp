#include "host/bvh/subtrees.hpp"

namespace stromboli::bvh {

CutTree cut(const BinaryTree& tree, uint32_t mostNodes) {
    CutTree result;
    std::vector<Subtree> pending{wholeTree(tree)};
    while (!pending.empty()) {
        const Subtree next = pending.back();
        pending.pop_back();
        if (next.size() <= mostNodes) {
            result.subtrees.push_back(next);
            continue;
        }
        result.above.push_back(next.first);
        pending.push_back(rightOf(tree, next));
        pending.push_back(leftOf(tree, next));
    }
    return result;
}

} // namespace stromboli::bvh

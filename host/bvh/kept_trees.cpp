#include "host/bvh/kept_trees.hpp"

#include "host/bvh/scene_part.hpp"

#include <utility>

namespace stromboli {

std::shared_ptr<const PartTree>
KeptTrees::treeOf(uint32_t number, Scene part, std::optional<double> padding,
                  const std::function<PartTree(const Scene&)>& build) {
    Kept& kept = kept_[number];
    if (kept.tree && kept.padding == padding && bvh::haveSameShape(kept.part, part))
        return kept.tree;
    kept = {};
    kept.tree = std::make_shared<const PartTree>(build(part));
    kept.part = std::move(part);
    kept.padding = padding;
    ++built_;
    return kept.tree;
}

} // namespace stromboli

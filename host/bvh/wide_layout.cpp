#include "host/bvh/wide_layout.hpp"

#include "host/bvh/layout_writer.hpp"
#include "host/bvh/leaf_items.hpp"
#include "host/bvh/two_level_layout.hpp"

namespace stromboli {

WideLayout buildWideBvh(const Scene& scene, const BuildOptions& options, KeptTrees* kept) {
    if (!scene.placements.empty() || scene.isMoment())
        return bvh::buildTwoLevels(scene, options, kept);
    const std::vector<bvh::LeafItem> items = bvh::makeLeafItems(scene);
    const BinaryTree tree = buildBinaryTree(bvh::itemBounds(scene, items), options);
    return bvh::writeLayout(scene, items, tree);
}

} // namespace stromboli

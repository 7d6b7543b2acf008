#include "host/bvh/wide_layout.hpp"

#include "host/bvh/node_record.hpp"
#include "host/bvh/two_level_layout.hpp"
#include "host/bvh/wide_tree.hpp"
#include "host/core/error.hpp"

#include <fmt/core.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace stromboli {

// --- The layout ----------------------------------------------------------------------------------

WideLayout buildWideBvh(const Scene& scene, const BuildOptions& options, KeptTrees* kept) {
    if (!scene.placements.empty() || scene.isMoment())
        return bvh::buildTwoLevels(scene, options, kept);
    const std::vector<bvh::LeafItem> items = bvh::makeLeafItems(scene);
    const bvh::ItemBoxes split =
        bvh::splitItems(scene, items, bvh::itemBounds(scene, items), options.split);
    return bvh::writeLayout(scene, items, split.itemOf, buildBinaryTree(split.boxes, options));
}

} // namespace stromboli

namespace stromboli::bvh {

// --- Writing it ----------------------------------------------------------------------------------

namespace {

/// Writes nodes and leaves where the packing says.
class LayoutWriter {
  public:
    LayoutWriter(const Scene& scene, std::span<const LeafItem> items,
                 std::span<const uint32_t> itemOf, const BinaryTree& tree, double padding)
        : scene_(scene), items_(items), itemOf_(itemOf), tree_(tree), padding_(padding),
          nodes_(collapse(tree)) {}

    WideLayout write() {
        const RecordPacking packing = packRecords(nodes_);
        if (packing.records > gpu::MAX_RECORDS)
            throw SceneError(fmt::format("BVH: {} records, expected at most {}", packing.records,
                                         gpu::MAX_RECORDS));
        const size_t primitives = scene_.triangles.size() + scene_.spheres.size();
        layout_.records.resize(packing.records); // zeros: leaves without area
        layout_.primitiveOrder.resize(primitives);
        layout_.placeOf.resize(primitives);
        layout_.firstCorner.resize(primitives);
        layout_.recordOfPlacement.resize(scene_.placements.size());
        // A group waits for each node between the root and the one visited, itself not included;
        // its children's groups wait while deeper nodes are visited, so never more than
        // packing.depth at once.
        layout_.stackSize = packing.depth + 1;
        findHomes(packing.places);
        tbb::parallel_for(tbb::blocked_range<size_t>(0, nodes_.size(), 256),
                          [&](const auto& range) {
                              for (size_t i = range.begin(); i != range.end(); ++i)
                                  writeNode(nodes_[i], packing.places[i]);
                          });
        return std::move(layout_);
    }

  private:
    /// The first leaf of an item, which stands for all of them.
    struct Home {
        uint32_t record = kNone;
        uint32_t entry = 0; ///< of the item's first primitive in the Primitive buffer

        static constexpr uint32_t kNone = 0xFFFFFFFFu;
    };

    void findHomes(std::span<const NodePlace> places) {
        homes_.resize(items_.size());
        uint32_t next = 0;
        for (size_t i = 0; i < nodes_.size(); ++i)
            for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot) {
                if (!nodes_[i].isLeaf(slot)) continue;
                const uint32_t item = itemOf(nodes_[i], slot);
                if (homes_[item].record != Home::kNone) continue;
                homes_[item] = {places[i].firstChild + slot, next};
                next += items_[item].count();
            }
    }

    uint32_t itemOf(const WideNode& node, uint32_t slot) const {
        return itemOf_[tree_.nodes[node.child[slot]].left];
    }

    void writeNode(const WideNode& node, const NodePlace& place) {
        ChildBoxes boxes;
        for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot) {
            if (node.has(slot)) boxes[slot] = tree_.nodes[node.child[slot]].bounds;
            if (node.isLeaf(slot)) writeLeaf(itemOf(node, slot), place.firstChild + slot);
        }
        layout_.records[place.record] =
            std::bit_cast<Record>(packNode(boxes, place.firstChild, padding_));
    }

    void writeLeaf(uint32_t number, uint32_t record) {
        const LeafItem& item = items_[number];
        const Home& home = homes_[number];
        if (item.isPlacement()) {
            layout_.recordOfPlacement[item.placement] = record;
            Record& r = layout_.records[record];
            r = {};
            r[3] = gpu::RECORD_IS_PLACEMENT;
            return;
        }
        layout_.records[record] = std::bit_cast<Record>(leafRecord(item, home));
        if (record != home.record) return;
        for (uint32_t slot = 0; slot < item.count(); ++slot) {
            const uint32_t primitive = item.primitive[slot];
            layout_.primitiveOrder[home.entry + slot] = primitive;
            layout_.placeOf[primitive] = 2 * record + slot;
            layout_.firstCorner[primitive] = item.firstCorner[slot];
        }
    }

    gpu::LeafRecord leafRecord(const LeafItem& item, const Home& home) const {
        const size_t triangles = scene_.triangles.size();
        if (item.primitive[0] >= triangles) {
            const Sphere& s = scene_.spheres[item.primitive[0] - triangles];
            return packLeaf({s.center, s.center, s.center, s.center},
                            std::bit_cast<uint32_t>(s.radius), home.entry | gpu::RECORD_IS_SPHERE);
        }
        const glm::vec3 p2 = corner(item, 0, 2), p3 = item.count() == 2 ? corner(item, 1, 2) : p2;
        return packLeaf({corner(item, 0, 0), corner(item, 0, 1), p2, p3}, home.record, home.entry);
    }

    glm::vec3 corner(const LeafItem& item, uint32_t slot, uint32_t c) const {
        const Triangle& t = scene_.triangles[item.primitive[slot]];
        return scene_.positions[t.corner[(c + item.firstCorner[slot]) % 3]];
    }

    static gpu::LeafRecord packLeaf(const std::array<glm::vec3, 4>& p, uint32_t homeOrRadius,
                                    uint32_t primitive) {
        return {p[0], primitive, p[1], gpu::NO_LIGHT, p[3], gpu::NO_LIGHT, p[2], homeOrRadius};
    }

    const Scene& scene_;
    std::span<const LeafItem> items_;
    std::span<const uint32_t> itemOf_; ///< by box that the tree was built over
    const BinaryTree& tree_;
    double padding_;
    std::vector<WideNode> nodes_;
    std::vector<Home> homes_; ///< by item
    WideLayout layout_;
};

} // namespace

WideLayout writeLayout(const Scene& scene, std::span<const LeafItem> items,
                       std::span<const uint32_t> itemOf, const BinaryTree& tree,
                       std::optional<double> padding) {
    const double ownPadding = tree.nodes.empty() ? 0 : boxPadding(tree.nodes.front().bounds);
    return LayoutWriter(scene, items, itemOf, tree, padding.value_or(ownPadding)).write();
}

} // namespace stromboli::bvh

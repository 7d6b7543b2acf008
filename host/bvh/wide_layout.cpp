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
    const BinaryTree tree = buildBinaryTree(bvh::itemBounds(scene, items), options);
    return bvh::writeLayout(scene, items, tree);
}

} // namespace stromboli

namespace stromboli::bvh {

// --- Writing it ----------------------------------------------------------------------------------

namespace {

/// Writes nodes and leaves where the packing says.
class LayoutWriter {
  public:
    LayoutWriter(const Scene& scene, std::span<const LeafItem> items, const BinaryTree& tree,
                 double padding)
        : scene_(scene), items_(items), tree_(tree), padding_(padding), nodes_(collapse(tree)) {}

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
        const std::vector<uint32_t> firstEntry = firstEntries();
        tbb::parallel_for(tbb::blocked_range<size_t>(0, nodes_.size(), 256),
                          [&](const auto& range) {
                              for (size_t i = range.begin(); i != range.end(); ++i)
                                  writeNode(nodes_[i], packing.places[i], firstEntry[i]);
                          });
        return std::move(layout_);
    }

  private:
    /// By node: the entry in the Primitive buffer of the first primitive in its leaves.
    std::vector<uint32_t> firstEntries() const {
        std::vector<uint32_t> first(nodes_.size());
        uint32_t next = 0;
        for (size_t i = 0; i < nodes_.size(); ++i) {
            first[i] = next;
            for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot)
                if (nodes_[i].isLeaf(slot)) next += itemOf(nodes_[i], slot).count();
        }
        return first;
    }

    const LeafItem& itemOf(const WideNode& node, uint32_t slot) const {
        return items_[tree_.nodes[node.child[slot]].left];
    }

    void writeNode(const WideNode& node, const NodePlace& place, uint32_t entry) {
        ChildBoxes boxes;
        for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot) {
            if (node.has(slot)) boxes[slot] = tree_.nodes[node.child[slot]].bounds;
            if (!node.isLeaf(slot)) continue;
            const LeafItem& item = itemOf(node, slot);
            writeLeaf(item, place.firstChild + slot, entry);
            entry += item.count();
        }
        layout_.records[place.record] =
            std::bit_cast<Record>(packNode(boxes, place.firstChild, padding_));
    }

    void writeLeaf(const LeafItem& item, uint32_t record, uint32_t entry) {
        if (item.isPlacement()) {
            layout_.recordOfPlacement[item.placement] = record;
            Record& r = layout_.records[record];
            r = {};
            r[3] = gpu::RECORD_IS_PLACEMENT;
            return;
        }
        layout_.records[record] = std::bit_cast<Record>(leafRecord(item, entry));
        for (uint32_t slot = 0; slot < item.count(); ++slot) {
            const uint32_t primitive = item.primitive[slot];
            layout_.primitiveOrder[entry + slot] = primitive;
            layout_.placeOf[primitive] = 2 * record + slot;
            layout_.firstCorner[primitive] = item.firstCorner[slot];
        }
    }

    gpu::LeafRecord leafRecord(const LeafItem& item, uint32_t entry) const {
        const size_t triangles = scene_.triangles.size();
        if (item.primitive[0] >= triangles) {
            const Sphere& s = scene_.spheres[item.primitive[0] - triangles];
            return packLeaf({s.center, s.center, s.center, s.center}, s.radius,
                            entry | gpu::RECORD_IS_SPHERE);
        }
        const glm::vec3 p2 = corner(item, 0, 2), p3 = item.count() == 2 ? corner(item, 1, 2) : p2;
        return packLeaf({corner(item, 0, 0), corner(item, 0, 1), p2, p3}, 0, entry);
    }

    glm::vec3 corner(const LeafItem& item, uint32_t slot, uint32_t c) const {
        const Triangle& t = scene_.triangles[item.primitive[slot]];
        return scene_.positions[t.corner[(c + item.firstCorner[slot]) % 3]];
    }

    static gpu::LeafRecord packLeaf(const std::array<glm::vec3, 4>& p, float radius,
                                    uint32_t primitive) {
        return {p[0], primitive, p[1], gpu::NO_LIGHT, p[3], gpu::NO_LIGHT, p[2], radius};
    }

    const Scene& scene_;
    std::span<const LeafItem> items_;
    const BinaryTree& tree_;
    double padding_;
    std::vector<WideNode> nodes_;
    WideLayout layout_;
};

} // namespace

WideLayout writeLayout(const Scene& scene, std::span<const LeafItem> items, const BinaryTree& tree,
                       std::optional<double> padding) {
    const double ownPadding = tree.nodes.empty() ? 0 : boxPadding(tree.nodes.front().bounds);
    return LayoutWriter(scene, items, tree, padding.value_or(ownPadding)).write();
}

} // namespace stromboli::bvh

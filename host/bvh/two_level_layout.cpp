#include "host/bvh/two_level_layout.hpp"

#include "host/bvh/layout_writer.hpp"
#include "host/bvh/leaf_items.hpp"
#include "host/bvh/node_record.hpp"
#include "host/bvh/scene_part.hpp"
#include "host/bvh/tree_assembly.hpp"
#include "scene/model/placements.hpp"

#include <cmath>
#include <utility>

namespace stromboli::bvh {
namespace {

/// Boxes of nodes a few levels down are together tighter, once they are in the world, than the box
/// of all.
constexpr uint32_t kBoxLevels = 6;

void collectBoxes(const BinaryTree& tree, uint32_t node, uint32_t levels,
                  std::vector<Bounds>& boxes) {
    const BinaryNode& n = tree.nodes[node];
    if (levels == 0 || n.isLeaf()) return boxes.push_back(n.bounds);
    collectBoxes(tree, n.left, levels - 1, boxes);
    collectBoxes(tree, n.right, levels - 1, boxes);
}

PartTree buildPart(const Scene& part, std::optional<double> padding, uint32_t boxLevels,
                   const BuildOptions& options) {
    const std::vector<LeafItem> items = makeLeafItems(part);
    const BinaryTree tree = buildBinaryTree(itemBounds(part, items), options);
    PartTree built{writeLayout(part, items, tree, padding), {}};
    if (!tree.nodes.empty()) collectBoxes(tree, 0, boxLevels, built.boxes);
    return built;
}

/// The number of what stands still in the world, among the parts whose trees are kept; prototypes
/// have those that follow.
constexpr uint32_t kStill = 0, kFirstPrototype = 1;

/// A tree that leads to others.
class TwoLevels {
  public:
    TwoLevels(const Scene& scene, const BuildOptions& options, KeptTrees* kept)
        : scene_(scene), options_(options), kept_(kept) {}

    WideLayout build() {
        buildPrototypes();
        splitWorld();
        const std::vector<Bounds> bounds = findItems();
        TreeAssembly assembly(scene_,
                              writeLayout(world_.scene, items_, buildBinaryTree(bounds, options_)),
                              world_.primitiveOf);
        if (stillTree_) {
            const auto last = uint32_t(scene_.placements.size());
            assembly.join(last, assembly.append(stillTree_->layout, still_.primitiveOf));
        }
        placePrototypes(assembly);
        return assembly.finish();
    }

  private:
    struct BuiltPrototype {
        std::shared_ptr<const PartTree> tree;
        std::vector<uint32_t> triangleOf;
    };

    std::shared_ptr<const PartTree> treeOf(uint32_t number, Scene part,
                                           std::optional<double> padding, uint32_t boxLevels) {
        const auto build = [&](const Scene& p) {
            return buildPart(p, padding, boxLevels, options_);
        };
        if (!kept_) return std::make_shared<const PartTree>(build(part));
        return kept_->treeOf(number, std::move(part), padding, build);
    }

    void buildPrototypes() {
        for (uint32_t i = 0; i < scene_.prototypes.size(); ++i) {
            const Prototype& p = scene_.prototypes[i];
            ScenePart part = partOf(scene_, p.firstTriangle, p.firstTriangle + p.triangles);
            prototypes_.push_back(
                {treeOf(kFirstPrototype + i, std::move(part.scene), {}, kBoxLevels),
                 std::move(part.primitiveOf)});
        }
    }

    /// What stands still has a tree of its own where an animation moves the rest.
    void splitWorld() {
        const bool isMoment = scene_.isMoment();
        std::vector<uint32_t> still, moving;
        for (uint32_t t = scene_.firstInWorld(); t < scene_.triangles.size(); ++t)
            (isMoment && !scene_.moves(scene_.triangles[t].instance) ? still : moving).push_back(t);
        still_ = partOf(scene_, std::move(still));
        world_ = partOf(scene_, std::move(moving));
        world_.scene.spheres = scene_.spheres;
        for (uint32_t i = 0; i < scene_.spheres.size(); ++i)
            world_.primitiveOf.push_back(uint32_t(scene_.triangles.size()) + i);
        world_.scene.placements = scene_.placements;
    }

    /// Returns the boxes of the items of the tree over the world.
    std::vector<Bounds> findItems() {
        items_ = makeLeafItems(world_.scene);
        std::vector<Bounds> bounds = itemBounds(world_.scene, items_);
        for (uint32_t i = 0; i < scene_.placements.size(); ++i) {
            const Placement& p = scene_.placements[i];
            const std::vector<Bounds>& boxes = prototypes_[p.prototype].tree->boxes;
            if (boxes.empty()) continue;
            addLeadingItem(i);
            bounds.emplace_back();
            for (const Bounds& box : boxes)
                bounds.back().extend(boundsInWorld(p, box));
        }
        if (!still_.scene.triangles.empty()) bounds.push_back(buildStill(bounds));
        return bounds;
    }

    /// Returns its box. The record that leads to its tree is that of a placement behind the others.
    Bounds buildStill(std::span<const Bounds> others) {
        Bounds whole = still_.scene.bounds();
        for (const Bounds& box : others)
            whole.extend(box);
        // Boxes are padded for all of the world (docs/numerics.md, "Boxes"). A power of two stays
        // the same from one moment to the next.
        const double padding = std::exp2(std::ceil(std::log2(boxPadding(whole))));
        stillTree_ = treeOf(kStill, std::move(still_.scene), padding, 0);
        addLeadingItem(uint32_t(scene_.placements.size()));
        world_.scene.placements.emplace_back();
        return stillTree_->boxes.front();
    }

    void addLeadingItem(uint32_t placement) {
        LeafItem item;
        item.placement = placement;
        items_.push_back(item);
    }

    void placePrototypes(TreeAssembly& assembly) {
        std::vector<uint32_t> roots;
        for (BuiltPrototype& prototype : prototypes_) {
            isEmpty_.push_back(prototype.tree->boxes.empty());
            roots.push_back(assembly.append(prototype.tree->layout, prototype.triangleOf));
            prototype = {}; // its memory is of use to the next
        }
        const std::vector<Bounds> boxes = prototypeBounds(scene_);
        for (uint32_t i = 0; i < scene_.placements.size(); ++i) {
            const uint32_t prototype = scene_.placements[i].prototype;
            if (!isEmpty_[prototype]) assembly.place(i, roots[prototype], boxes[prototype]);
        }
    }

    const Scene& scene_;
    const BuildOptions& options_;
    KeptTrees* kept_;
    std::vector<BuiltPrototype> prototypes_;
    std::vector<bool> isEmpty_;
    ScenePart world_, still_;
    std::vector<LeafItem> items_; ///< of the world
    std::shared_ptr<const PartTree> stillTree_;
};

} // namespace

WideLayout buildTwoLevels(const Scene& scene, const BuildOptions& options, KeptTrees* kept) {
    return TwoLevels(scene, options, kept).build();
}

} // namespace stromboli::bvh

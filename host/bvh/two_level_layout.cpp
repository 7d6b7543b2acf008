#include "host/bvh/two_level_layout.hpp"

#include "host/bvh/leaf_items.hpp"
#include "host/bvh/node_record.hpp"
#include "host/core/error.hpp"
#include "scene/model/placements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace stromboli::bvh {

// --- Parts of a scene ----------------------------------------------------------------------------

namespace {

/// Some of a scene's triangles as a scene of their own, with the positions that they use and
/// nothing else.
struct ScenePart {
    Scene scene;
    std::vector<uint32_t> primitiveOf; ///< by primitive of the part: its number in the whole scene
};

/// `triangles`: numbers of those in the part, in ascending order.
ScenePart partOf(const Scene& scene, std::vector<uint32_t> triangles) {
    ScenePart part;
    // A mesh uses a run of positions; numbers within it need no table over all of the scene's.
    uint32_t least = std::numeric_limits<uint32_t>::max(), most = 0;
    for (const uint32_t t : triangles)
        for (const uint32_t corner : scene.triangles[t].corner)
            least = std::min(least, corner), most = std::max(most, corner);
    constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> number(triangles.empty() ? 0 : most - least + 1, kUnused);
    for (const uint32_t t : triangles) {
        part.scene.triangles.push_back(scene.triangles[t]);
        for (uint32_t& corner : part.scene.triangles.back().corner) {
            uint32_t& found = number[corner - least];
            if (found == kUnused) {
                found = uint32_t(part.scene.positions.size());
                part.scene.positions.push_back(scene.positions[corner]);
            }
            corner = found;
        }
    }
    part.primitiveOf = std::move(triangles);
    return part;
}

/// Triangles from `first` on, up to `end`.
ScenePart partOf(const Scene& scene, uint32_t first, uint32_t end) {
    std::vector<uint32_t> triangles(end - first);
    std::iota(triangles.begin(), triangles.end(), first);
    return partOf(scene, std::move(triangles));
}

/// Whether a tree over one part is one over the other: as many triangles with the same corners,
/// bit for bit.
bool haveSameShape(const Scene& a, const Scene& b) {
    const auto bytes = [](const Scene& s) { return std::as_bytes(std::span(s.positions)); };
    return std::ranges::equal(bytes(a), bytes(b)) &&
           std::ranges::equal(a.triangles, b.triangles, [](const Triangle& s, const Triangle& t) {
               return std::ranges::equal(s.corner, t.corner);
           });
}

} // namespace

} // namespace stromboli::bvh

namespace stromboli {

// --- Trees kept between moments ------------------------------------------------------------------

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

namespace stromboli::bvh {

// --- Trees put together --------------------------------------------------------------------------

namespace {

/// By how much rays may stray in the prototype's space (docs/theory/numerics.md, "Instances"): in
/// units of u, the sums of |B| times 15 of the ray's origin, 35 of the prototype's reach E, and 1
/// of where it is, m; as 16 times the first, 36 / 16 of the second and 1 / 16 of the third. A
/// little more covers the rounding of all this.
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
    gpu::LeafRecord leaf = asLeaf(record); // of triangles: spheres are in the world
    leaf.primitive += entry;
    leaf.homeOrRadius += base;
    return std::bit_cast<Record>(leaf);
}

/// Puts trees together: one over the world, whose leaves lead to others, and these behind it.
class TreeAssembly {
  public:
    /// world: the tree that has the root; primitiveOf: of the scene, by primitive of that tree.
    /// `scene` must outlive the object.
    TreeAssembly(const Scene& scene, WideLayout world, std::span<const uint32_t> primitiveOf);

    /// Adds a tree; returns the record of its root. primitiveOf: of the scene, by primitive of the
    /// tree.
    uint32_t append(const WideLayout& tree, std::span<const uint32_t> primitiveOf);

    /// Lets the record of a placement lead to the tree of its prototype, which was appended.
    /// box: of the prototype, in its own space.
    void place(uint32_t placement, uint32_t root, const Bounds& box);

    /// Lets the record of a placement be the root of a tree that was appended and is in world
    /// space.
    void join(uint32_t placement, uint32_t root);

    WideLayout finish();

  private:
    const Scene& scene_;
    WideLayout layout_;
    uint32_t levels_ = 0; ///< most stack entries of an appended tree
};

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

// --- Both levels ---------------------------------------------------------------------------------

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
    const ItemBoxes split = splitItems(part, items, itemBounds(part, items), options.split);
    const BinaryTree tree = buildBinaryTree(split.boxes, options);
    PartTree built{writeLayout(part, items, split.itemOf, tree, padding), {}};
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
        const ItemBoxes split = splitItems(world_.scene, items_, findItems(), options_.split);
        TreeAssembly assembly(
            scene_,
            writeLayout(world_.scene, items_, split.itemOf, buildBinaryTree(split.boxes, options_)),
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
        // Boxes are padded for all of the world (docs/theory/numerics.md, "Boxes"). A power of two
        // stays the same from one moment to the next.
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

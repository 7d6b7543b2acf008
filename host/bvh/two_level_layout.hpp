#pragma once

#include "host/bvh/wide_layout.hpp"
#include "scene/model/scene.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// --- Trees kept between moments ------------------------------------------------------------------

/// The tree over a part of a scene.
struct PartTree {
    WideLayout layout;         ///< primitives have the numbers of the part
    std::vector<Bounds> boxes; ///< which together hold it; none of a part without primitives
};

/// The trees of parts of a scene that stand still, kept from one moment of an animation for the
/// next. The same parts have the same trees, whether they are kept or built.
class KeptTrees {
  public:
    /// number: tells the parts of a scene apart. part: its geometry. padding: of the tree's boxes
    /// (bvh::boxPadding), where it is not that of its own box. The tree is built anew where either
    /// is not as it was the last time.
    std::shared_ptr<const PartTree> treeOf(uint32_t number, Scene part,
                                           std::optional<double> padding,
                                           const std::function<PartTree(const Scene&)>& build);

    /// Trees that were built so far.
    uint64_t built() const { return built_; }

  private:
    struct Kept {
        Scene part;
        std::optional<double> padding;
        std::shared_ptr<const PartTree> tree;
    };
    std::map<uint32_t, Kept> kept_; ///< by number
    uint64_t built_ = 0;
};

} // namespace stromboli

namespace stromboli::bvh {

// --- Parts of a scene ----------------------------------------------------------------------------

/// Some of a scene's triangles as a scene of their own, with the positions that they use and
/// nothing else.
struct ScenePart {
    Scene scene;
    std::vector<uint32_t> primitiveOf; ///< by primitive of the part: its number in the whole scene
};

/// Triangles from `first` on, up to `end`.
ScenePart partOf(const Scene& scene, uint32_t first, uint32_t end);

/// `triangles`: numbers of those in the part, in ascending order.
ScenePart partOf(const Scene& scene, std::vector<uint32_t> triangles);

/// Whether a tree over one part is one over the other: as many triangles with the same corners,
/// bit for bit.
bool haveSameShape(const Scene& a, const Scene& b);

// --- Trees put together --------------------------------------------------------------------------

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

// --- Both levels ---------------------------------------------------------------------------------

/// The layout of a scene with placements, or of a moment of an animation: a tree over its triangles
/// and spheres in the world and its placements, and one for each prototype; where things move, also
/// one for the triangles in the world that stand still, which the tree over the world leads to.
WideLayout buildTwoLevels(const Scene& scene, const BuildOptions& options, KeptTrees* kept);

} // namespace stromboli::bvh

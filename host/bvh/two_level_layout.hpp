#pragma once

#include "host/bvh/wide_layout.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
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

// --- Both levels ---------------------------------------------------------------------------------

/// The layout of a scene with placements, or of a moment of an animation: a tree over its triangles
/// and spheres in the world and its placements, and one for each prototype; where things move, also
/// one for the triangles in the world that stand still, which the tree over the world leads to.
WideLayout buildTwoLevels(const Scene& scene, const BuildOptions& options, KeptTrees* kept);

} // namespace stromboli::bvh

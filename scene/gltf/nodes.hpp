#pragma once

#include "scene/gltf/animation.hpp"
#include "scene/gltf/meshes.hpp"

#include <glm/glm.hpp>

#include <map>
#include <optional>
#include <vector>

namespace stromboli::gltf {

/// The nodes of a file: a forest, in which each has a place in the world.
class Nodes {
  public:
    /// The first of several parents of a node counts; nodes that are their own ancestors are left
    /// out.
    explicit Nodes(Context& context);

    /// Places whatever the nodes of the chosen scene show.
    void place();

  private:
    void readNodes();
    void findParents();
    void findTransforms();
    glm::dmat4 localTransform(size_t node) const;
    std::vector<size_t> rootsOfScene() const;
    void placeNode(size_t node);
    void placeLightOf(const Element& node, size_t index);
    /// Runs `place`; what it cannot read is left out.
    template <class Place>
    void placeOrLeaveOut(build::Shortfall kind, Place&& place);
    void placeMesh(const Element& node, size_t index);
    std::vector<glm::dmat4> placesOf(const Element& node, const glm::dmat4& toWorld) const;
    std::vector<glm::dmat4> readPlaces(const Element& attributes, const glm::dmat4& toWorld) const;
    std::vector<glm::dmat4> jointsOf(const Element& node) const;
    /// Whether the animation moves or deforms the node's mesh.
    bool isMoved(const Element& node, size_t index, bool hasSkin) const;

    Context& context_;
    const Document& document_;
    Meshes meshes_;
    std::map<size_t, AnimatedNode> animated_;
    std::vector<size_t> roots_; ///< nodes without a parent
    // For each node:
    std::vector<std::optional<Element>> nodes_; ///< nothing: it cannot be read
    std::vector<std::vector<size_t>> children_;
    std::vector<glm::dmat4> toWorld_;
    std::vector<bool> moves_; ///< the animation moves it or an ancestor
};

} // namespace stromboli::gltf

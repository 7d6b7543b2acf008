#pragma once

#include "scene/gltf/animation.hpp"
#include "scene/gltf/meshes.hpp"

#include <glm/glm.hpp>

#include <map>
#include <vector>

namespace stromboli::gltf {

/// The nodes of a file: a forest, in which each has a place in the world.
class Nodes {
  public:
    /// Throws SceneError if a node has two parents or is its own ancestor.
    explicit Nodes(Context& context);

    /// Places whatever the nodes of the chosen scene show.
    void place();

  private:
    std::vector<size_t> childrenOf(size_t node) const;
    void findParents();
    void findTransforms();
    glm::dmat4 localTransform(size_t node) const;
    std::vector<size_t> rootsOfScene() const;
    void placeNode(size_t node);
    void placeMesh(const Element& node, size_t index);
    std::vector<glm::dmat4> placesOf(const Element& node, const glm::dmat4& toWorld) const;
    std::vector<glm::dmat4> jointsOf(const Element& node) const;
    /// Whether the animation moves or deforms the node's mesh.
    bool isMoved(const Element& node, size_t index) const;

    Context& context_;
    const Document& document_;
    Meshes meshes_;
    std::map<size_t, AnimatedNode> animated_;
    std::vector<size_t> roots_; ///< nodes without a parent
    // For each node:
    std::vector<glm::dmat4> toWorld_;
    std::vector<bool> moves_; ///< the animation moves it or an ancestor
};

} // namespace stromboli::gltf

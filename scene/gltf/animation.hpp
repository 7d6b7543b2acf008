#pragma once

#include "scene/gltf/context.hpp"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <map>
#include <optional>
#include <vector>

namespace stromboli::gltf {

/// What an animation says of a node at a time, instead of what the node says.
struct AnimatedNode {
    std::optional<glm::dvec3> translation, scale;
    std::optional<glm::dquat> rotation;
    std::vector<double> weights;

    bool isPosed() const { return translation || rotation || scale; }
};

/// The file's first animation, and those of nodes that none before moves, at the time that `--at`
/// asks for; empty without it.
std::map<size_t, AnimatedNode> animatedNodes(Context& context);

/// The last key frame of these animations, in seconds; 0: there is none that can be read.
double animationEnd(const Document& document);

} // namespace stromboli::gltf

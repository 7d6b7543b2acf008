#pragma once

#include "scene/collada/context.hpp"
#include "scene/collada/joints.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <unordered_map>

namespace stromboli::collada {

/// What an <instance_controller> shows when nothing moves: a geometry and where it stands.
struct RestPose {
    const Element* geometry = nullptr; ///< null: nothing
    glm::dmat4 toWorld{1};
};

/// The <controller>s of the document, each read once. A skin is shown in the shape in which it was
/// bound to its joints, carried along to where the first of them stands; a morph as its base mesh,
/// in its node. Both are reported.
class Controllers {
  public:
    /// `fileToWorld`: the matrix of the document's visual scene.
    Controllers(Context& context, const glm::dmat4& fileToWorld)
        : context_(context), joints_(context.document), fileToWorld_(fileToWorld) {}

    /// `nodeToWorld` is the matrix of the instance's node. Throws SceneError for controllers that
    /// contain themselves, and for references that lead nowhere.
    RestPose restPose(const Element& instance, const glm::dmat4& nodeToWorld);

  private:
    /// How a skin's mesh was bound.
    struct Binding {
        glm::dmat4 shape{1};               ///< from the mesh to where it was bound
        JointName joint;                   ///< the first one
        std::optional<glm::dmat4> toJoint; ///< from where it was bound to that joint's space
    };
    struct Controller {
        const Element* geometry = nullptr;
        const Element* form = nullptr;  ///< <skin> or <morph>; null: it has neither
        std::optional<Binding> binding; ///< of a skin
    };

    const Controller& read(const Element& element);
    const Element* geometryBehind(const Element& form) const;
    Binding readBinding(const Element& skin) const;
    glm::dmat4 boundToWorld(const Controller& controller, const Element& instance,
                            const glm::dmat4& nodeToWorld);

    Context& context_;
    Joints joints_;
    glm::dmat4 fileToWorld_;
    std::unordered_map<const Element*, Controller> read_;
};

} // namespace stromboli::collada

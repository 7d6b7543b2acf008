#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace stromboli {

/// What becomes different in a scene between two pictures of it, by numbers in the scene. All in
/// the scene's own space (Scene::origin).
struct SceneChange {
    /// Those that differ in numbers alone: colours, roughness, indices, emission
    /// (differInNumbers()).
    std::map<uint32_t, Material> materials;
    /// Those of the same kind, with the same picture.
    std::map<uint32_t, Light> lights;
    /// By instance: the motion from where the scene as it was read has it; the identity puts it
    /// back. An affine matrix that has an inverse and does not mirror; that of a sphere stretches
    /// all directions alike. A border of a medium that differs from place to place does not move.
    std::map<uint32_t, glm::dmat4> motions = {};
    /// Environment::rotation of the scene's environment, which only turns.
    std::optional<float> rotation = {};
    /// In place of the scene's environment, as of a sun that is elsewhere; a picture as that is.
    std::shared_ptr<const Environment> environment = {};
};

/// A scene's copy that changes, again and again, while the scene itself stays as it is.
class ChangingScene {
  public:
    explicit ChangingScene(std::shared_ptr<const Scene> original);

    /// Throws std::invalid_argument, which says what is not there or cannot be so, and then has
    /// changed nothing.
    void apply(const SceneChange& change);

    const Scene& original() const { return *original_; }
    /// The same object after every change.
    const std::shared_ptr<Scene>& scene() const { return scene_; }

  private:
    /// A number in scene(), and what it comes from in the original.
    struct Own {
        uint32_t number = 0, original = 0;
    };
    /// What moves with an instance, and belongs to it alone.
    struct Parts {
        std::vector<Own> positions, normals, tangents; ///< tangents: into Scene::attributes
        std::vector<uint32_t> triangles;               ///< in the world
        std::vector<uint32_t> spheres, placements;
    };

    void require(const SceneChange& change) const;
    Parts partsOf(uint32_t instance) const;
    bool boundsGrid(const Parts& parts) const;
    void makeOwn(Parts& parts);
    void move(uint32_t instance, const glm::dmat4& motion);

    std::shared_ptr<const Scene> original_;
    std::shared_ptr<Scene> scene_;
    std::map<uint32_t, Parts> moved_; ///< by instance, from its first motion on
};

} // namespace stromboli

#pragma once

#include "host/film/film.hpp"
#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <span>
#include <string>
#include <vector>

namespace stromboli {

// A shadow catcher is a surface that is not in the picture, but whose shadows and other changes of
// its light are: what is behind the picture looks as if the objects stood on it. Several pictures
// make one: that of the objects, without the catcher before the camera; that of the catcher among
// the objects, without them before the camera, H; and that of the catcher without them, G. Both
// have the same lights and random numbers, so that where the objects change nothing they are the
// same, and nothing is caught. What objects shine by themselves is therefore a picture of its own,
// the glow.

/// The name of what --ground puts into a scene.
inline constexpr const char* kGroundName = "ground";

/// The scenes of these pictures. Lamps are no objects: surfaces whose emission no texture changes.
Scene withoutCatcher(const Scene& scene, const std::string& catcher);
Scene catcherAmongObjects(const Scene& scene, const std::string& catcher);
Scene catcherAlone(const Scene& scene, const std::string& catcher);
/// Without any other light than the objects' own.
Scene catcherInGlow(const Scene& scene, const std::string& catcher);
/// Whether some object shines.
bool objectsGlow(const Scene& scene);

/// Throws SceneError if no object or material has the catcher's name, if it is shown as an
/// instance, and if the scene has media, which a catcher cannot stand in.
void requireCatcher(const Scene& scene, const std::string& catcher);

/// What a catcher does to what is behind the picture, by pixel: B becomes clear B + added.
struct CaughtLight {
    std::vector<glm::vec3> added; ///< radiance
    std::vector<float> clear;     ///< in [0, 1]
};

/// amongObjects, alone: H and G; glow: may be empty; coverage: the share of each pixel that the
/// catcher covers without the objects. With s = min(1, H / G), of the channel that has the least,
/// clear is 1 - coverage (1 - s) and added is H - s G + glow. What is behind is darkened as much as
/// the catcher, and where it is as bright as the catcher without objects it becomes what that is
/// with them.
CaughtLight caughtLight(const Film& amongObjects, const Film& alone, const Film& glow,
                        std::span<const float> coverage);

/// Adds what was caught to the means of the objects' picture, of whose pixels these cover `alpha`,
/// and to alpha what the catcher hides of what is behind.
void putUnder(Film& objects, std::span<const float> alpha, const CaughtLight& caught);
void addShadow(std::span<float> alpha, const CaughtLight& caught);

} // namespace stromboli

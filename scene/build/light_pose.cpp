#include "scene/build/light_pose.hpp"

#include "scene/build/vectors.hpp"

#include <optional>

namespace stromboli::build {

bool poseLight(Light& light, const glm::dmat4& toWorld, const SceneConventions& conventions) {
    const glm::dvec3 position = toWorld[3], ahead = -glm::dvec3(toWorld[2]);
    if (light.kind == LightKind::Ambient) return true;
    if (!inRange(position)) return false;
    light.position = position;
    if (light.kind == LightKind::Point) return true;

    const bool aimsByPoint = light.kind == LightKind::Directional &&
                             conventions.directionalAim == DirectionalAim::NodePoint;
    const std::optional<glm::dvec3> direction = unit(aimsByPoint ? -(position + ahead) : ahead);
    if (!direction) return false;
    light.direction = *direction;
    if (light.kind != LightKind::Area) return true;

    const glm::dvec3 x = -glm::dvec3(toWorld[0]), y = toWorld[1];
    if (!inRange(x) || !inRange(y)) return false;
    light.edgeX = x, light.edgeY = y;
    // A sheared node tilts its axis against the rectangle; an emitter's light leaves at right
    // angles to it.
    const std::optional<glm::dvec3> normal = unit(glm::cross(x, y));
    if (!normal) return false;
    if (conventions.areaLights == AreaLights::BecomeGeometry)
        light.direction = glm::dot(*normal, *direction) < 0 ? -*normal : *normal;
    return true;
}

} // namespace stromboli::build

#include "scene/add_fog.hpp"

#include <algorithm>

namespace stromboli {
namespace {

/// Light from infinity would not come through fog without an end.
bool isLitFromInfinity(const Scene& scene) {
    return scene.environment || std::ranges::any_of(scene.lights, [](const Light& light) {
               return light.kind == LightKind::Ambient || light.kind == LightKind::Directional;
           });
}

/// A sphere that light passes, between the fog and nothing, which reaches one diagonal beyond what
/// is there.
void addEdge(Scene& scene, const Bounds& bounds) {
    Material edge;
    edge.name = "edge of the fog";
    edge.albedo = glm::vec3(0);
    edge.alphaMode = AlphaMode::Blend;
    edge.opacity = 0;
    edge.boundsMedia = true;
    edge.inside = scene.surrounding;
    scene.materials.push_back(edge);
    scene.instances.push_back(edge.name);
    const float diagonal = glm::length(bounds.extent());
    scene.spheres.push_back({0.5f * (bounds.lo + bounds.hi), diagonal > 0 ? 1.5f * diagonal : 1,
                             uint32_t(scene.materials.size() - 1),
                             uint32_t(scene.instances.size() - 1)});
    if (!scene.movingInstances.empty()) scene.movingInstances.push_back(false);
}

} // namespace

void addFog(Scene& scene, const FogRequest& request) {
    Medium fog;
    fog.name = "fog";
    const glm::vec3 color = glm::clamp(request.color, 0.0f, 1.0f);
    fog.scattering = float(request.density) * color;
    fog.absorption = float(request.density) * (1.0f - color);
    fog.asymmetry = std::clamp(float(request.asymmetry), -kMostAsymmetry, kMostAsymmetry);
    const Bounds bounds = scene.framed(); // a floor reaches much farther
    const bool hasEdge = isLitFromInfinity(scene) && !bounds.empty();
    if (!scene.framing) scene.framing = bounds;
    scene.surrounding = uint32_t(scene.media.size());
    scene.media.push_back(fog);
    for (Material& m : scene.materials)
        if (m.boundsMedia && m.outside == kNoMedium) m.outside = scene.surrounding;
    if (hasEdge) addEdge(scene, bounds);
    resolveMedia(scene);
}

} // namespace stromboli

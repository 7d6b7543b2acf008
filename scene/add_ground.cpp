#include "scene/add_ground.hpp"

#include <initializer_list>

namespace stromboli {

void addGround(Scene& scene, const GroundRequest& request) {
    if (!scene.framing) scene.framing = scene.bounds();
    const Bounds bounds = request.under.value_or(scene.bounds());
    const float diagonal = bounds.empty() ? 0 : glm::length(bounds.extent());
    const float size = diagonal > 0 ? diagonal : 1;
    const glm::vec3 middle = bounds.empty() ? glm::vec3(0) : 0.5f * (bounds.lo + bounds.hi);
    // Seen from the height of the model the edge is a twentieth of a degree below the horizon. Many
    // models have a floor of their own, which is to be the one that is seen.
    const float reach = 1000 * size;
    const float y = (bounds.empty() ? 0 : bounds.lo.y) - size / 4096;
    Material material;
    material.name = "ground";
    material.albedo = glm::clamp(request.color, 0.0f, 1.0f);
    scene.materials.push_back(material);
    scene.instances.push_back(material.name);
    if (!scene.movingInstances.empty()) scene.movingInstances.push_back(false);
    const auto first = uint32_t(scene.positions.size());
    for (const glm::vec2& corner :
         {glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, -1)})
        scene.positions.emplace_back(middle.x + reach * corner.x, y, middle.z + reach * corner.y);
    for (const uint32_t last : {2u, 3u}) {
        Triangle t;
        t.corner[0] = first, t.corner[1] = first + last - 1, t.corner[2] = first + last;
        t.material = uint32_t(scene.materials.size() - 1);
        t.instance = uint32_t(scene.instances.size() - 1);
        scene.triangles.push_back(t);
        if (!scene.attributeCorners.empty())
            scene.attributeCorners.push_back({kNoAttributes, kNoAttributes, kNoAttributes});
    }
}

} // namespace stromboli

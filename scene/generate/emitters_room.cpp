#include "scene/generate/emitters_room.hpp"

#include "scene/generate/cornell_mesh.hpp"

#include <cmath>
#include <random>

namespace stromboli {
namespace {

/// The engine is standardised, distributions are not.
double fraction(std::mt19937& engine) {
    return uint32_t(engine()) * 0x1p-32;
}

void addOctahedron(Scene& scene, const glm::vec3& center, float radius, uint32_t material,
                   uint32_t instance) {
    const auto first = uint32_t(scene.positions.size());
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-radius, radius}) {
            glm::vec3 corner = center;
            corner[axis] += side;
            scene.positions.push_back(corner);
        }
    for (uint32_t octant = 0; octant < 8; ++octant) {
        const uint32_t x = octant & 1, y = octant >> 1 & 1, z = octant >> 2;
        Triangle t;
        t.material = material;
        t.instance = instance;
        t.corner[0] = first + x;
        t.corner[1] = first + 2 + y;
        t.corner[2] = first + 4 + z;
        if ((x + y + z) % 2 == 0) std::swap(t.corner[1], t.corner[2]); // normals point out
        scene.triangles.push_back(t);
    }
}

/// Somewhere in the room.
glm::vec3 placeIn(std::mt19937& engine) {
    glm::vec3 place;
    for (int axis = 0; axis < 3; ++axis)
        place[axis] = float(1.9 * fraction(engine) - 0.95);
    return place;
}

Scene emptyRoom(const std::string& source) {
    constexpr uint32_t kSmallestMesh = 3; // steps of a knot that is not used
    CornellMesh room = cornellMesh(kSmallestMesh, kSmallestMesh);
    room.knot = {};
    room.walls.pop_back(); // its emitter
    return cornellMeshScene(room, source);
}

} // namespace

Scene emittersRoom(uint32_t triangles, const std::string& source) {
    Scene scene = emptyRoom(source);
    Material emitter;
    emitter.name = "emitter";
    emitter.albedo = glm::vec3(0.0f);
    emitter.emission = {40, 32, 24};
    emitter.emitsBothSides = false;
    scene.materials.push_back(emitter);
    const auto material = uint32_t(scene.materials.size() - 1);
    scene.instances.push_back("emitters");
    const auto instance = uint32_t(scene.instances.size() - 1);
    std::mt19937 engine(1);
    for (uint32_t i = 0; i < triangles / 8; ++i) {
        const glm::vec3 center = placeIn(engine);
        const auto radius = float(0.004 * std::exp2(3 * fraction(engine)));
        addOctahedron(scene, center, radius, material, instance);
    }
    return scene;
}

Scene pointsRoom(uint32_t lights, const std::string& source) {
    Scene scene = emptyRoom(source);
    std::mt19937 engine(2);
    for (uint32_t i = 0; i < lights; ++i) {
        Light& light = scene.lights.emplace_back();
        light.name = "point";
        light.kind = LightKind::Point;
        light.position = placeIn(engine);
        light.color = glm::vec3(float(std::pow(10.0, 6 * fraction(engine) - 6)));
        light.constantAttenuation = 0;
        light.quadraticAttenuation = 1;
    }
    return scene;
}

} // namespace stromboli

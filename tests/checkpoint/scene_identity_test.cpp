// What a checkpoint takes for another scene.
#include "host/checkpoint/scene_identity.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>

namespace stromboli {
namespace {

Scene smallScene() {
    Scene scene;
    scene.file = "a.dae";
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    scene.normals = {{0, 0, 1}};
    scene.triangles.resize(2);
    scene.spheres.resize(1);
    scene.materials.resize(2);
    scene.lights.resize(1);
    return scene;
}

TEST(SceneIdentity, EveryMemberCounts) {
    using Change = std::function<void(Scene&, Camera&)>;
    const Change changes[] = {
        [](Scene&, Camera&) {},
        [](Scene& s, Camera&) { s.positions[3].z = 2; },
        [](Scene& s, Camera&) { s.positions.pop_back(); },
        [](Scene& s, Camera&) {
            s.normals[0] = {0, 1, 0};
        },
        [](Scene& s, Camera&) { s.triangles[1].corner[2] = 3; },
        [](Scene& s, Camera&) { s.triangles[1].material = 1; },
        [](Scene& s, Camera&) { s.spheres[0].radius = 2; },
        [](Scene& s, Camera&) { s.materials[1].albedo.y = 0.25f; },
        [](Scene& s, Camera&) { s.materials[1].kind = MaterialKind::Dielectric; },
        [](Scene& s, Camera&) { s.materials[1].emitsBothSides = false; },
        [](Scene& s, Camera&) { s.lights[0].color.x = 2; },
        [](Scene& s, Camera&) { s.lights[0].falloffAngle = 1; },
        [](Scene& s, Camera&) { s.lights[0].innerAngle = 1; },
        [](Scene& s, Camera&) { s.lights.push_back({}); },
        [](Scene& s, Camera&) { s.materials[1].principled.roughness = 0.5f; },
        [](Scene& s, Camera&) { s.materials[1].alphaCutoff = 0.25f; },
        [](Scene& s, Camera&) { s.materials[1].isBlackBehind = true; },
        [](Scene& s, Camera&) { s.materials[1].isHiddenFromCamera = true; },
        [](Scene& s, Camera&) { s.materials[1].textures.push_back({}); },
        [](Scene& s, Camera&) {
            s.images.push_back({"a", 1, 1, TexelFormat::Rgba8, {7}});
        },
        [](Scene& s, Camera&) { s.textures.push_back({}); },
        [](Scene& s, Camera&) { s.attributes.push_back({}); },
        [](Scene& s, Camera&) { s.environment.emplace(); },
        [](Scene& s, Camera&) { s.portals.emplace_back(); },
        [](Scene& s, Camera&) { s.portals.emplace_back().edgeB.y = 2; },
        [](Scene& s, Camera&) {
            s.environment.emplace();
            s.environment->rotation = 1;
        },
        [](Scene&, Camera& c) { c.position.x = 1e-9; },
        [](Scene&, Camera& c) { c.lensRadius = 1e-9; },
        [](Scene&, Camera& c) { c.focusDistance = 2; },
        [](Scene&, Camera& c) { c.shift.x = 1e-9; },
        [](Scene&, Camera& c) { c.shift.y = 1e-9; },
        [](Scene&, Camera& c) { c.clipAlongRay = true; },
    };
    std::set<uint32_t> sums;
    for (const Change& change : changes) {
        Scene scene = smallScene();
        Camera camera;
        change(scene, camera);
        sums.insert(sceneIdentity(scene, camera));
    }
    EXPECT_EQ(sums.size(), std::size(changes));
}

uint32_t identityOf(MaterialKind kind, const std::function<void(Material&)>& change) {
    Scene scene = smallScene();
    scene.materials[1].kind = kind;
    change(scene.materials[1]);
    return sceneIdentity(scene, {});
}

/// Whatever the order of kinds. What light meets as facets counts, and a kind without them keeps
/// the identity that it had before there were any.
TEST(SceneIdentity, FacetsCountForKindsThatHaveThem) {
    using enum MaterialKind;
    const std::function<void(Material&)> changes[] = {
        [](Material& m) { m.facets.distribution = FacetDistribution::Beckmann; },
        [](Material& m) { m.facets.alpha = glm::vec2(0.3f); },
        [](Material& m) { m.facets.alpha.y = 0.3f; },
        [](Material& m) { m.isNonlinear = !m.isNonlinear; }};
    for (const auto& change : changes) {
        for (const MaterialKind kind : {Conductor, Dielectric, Plastic})
            EXPECT_NE(identityOf(kind, change), identityOf(kind, [](Material&) {}))
                << int(kind) << ' ' << &change - changes;
        for (const MaterialKind kind : {Diffuse, Mirror, Refraction, Principled})
            EXPECT_EQ(identityOf(kind, change), identityOf(kind, [](Material&) {}))
                << int(kind) << ' ' << &change - changes;
    }
}

TEST(SceneIdentity, NamesDoNotCount) {
    Scene scene = smallScene();
    const uint32_t before = sceneIdentity(scene, {});
    scene.file = "b.dae";
    scene.materials[0].name = "red";
    scene.lights[0].name = "sun";
    EXPECT_EQ(sceneIdentity(scene, {}), before);
}

} // namespace
} // namespace stromboli

// Scenes that change while a session shows them: lights and places of objects.
#include "tests/engine/engine_fixture.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/core/error.hpp"
#include "host/engine/load_scene.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "scene/model/placements.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/kernel/window_room.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

namespace stromboli {
namespace {

using namespace test;

const DeviceRequest kOnReference{.backend = BackendChoice::Reference};

SceneChange motionOf(uint32_t object, const glm::dmat4& motion) {
    return {.materials = {}, .lights = {}, .motions = {{object, motion}}};
}

glm::dmat4 shifted(double x, double y, double z) {
    return glm::translate(glm::dmat4(1), {x, y, z});
}

/// The number of the first object that has a triangle in the world and emits nothing.
uint32_t meshOf(const Scene& scene) {
    for (uint32_t t = scene.firstInWorld(); t < scene.triangles.size(); ++t)
        if (!scene.materials[scene.triangles[t].material].emits())
            return scene.triangles[t].instance;
    throw std::logic_error("the scene has no such mesh");
}

/// The scene with a change.
std::shared_ptr<Scene> changed(const std::shared_ptr<const Scene>& scene,
                               const SceneChange& change) {
    ChangingScene changing(scene);
    changing.apply(change);
    return changing.scene();
}

/// Moves `object` in a session of its own, away, farther and back; builds tell how often.
void expectMotionsToShow(const std::shared_ptr<Scene>& scene, uint32_t object,
                         const DeviceRequest& device) {
    const RenderRequest request = smallPicture(8);
    const SceneChange away = motionOf(object, shifted(0.125, 0.0625, 0)),
                      farther =
                          motionOf(object, glm::rotate(shifted(-0.25, 0.125, 0.5), 0.5, {0, 1, 0}));
    RenderSession session(device);
    session.begin(scene, request);
    session.run();
    const Film before = session.film();
    session.change(away);
    session.pass(after(1, Next::Pause));
    session.change(farther);
    session.run();
    EXPECT_FALSE(sameBytes(session.film(), before));
    EXPECT_TRUE(sameBytes(session.film(), alone(device, changed(scene, farther), request)));
    session.change(motionOf(object, glm::dmat4(1)));
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), before));
}

TEST(SceneChange, MovedObjectsHaveTheBytesOfASessionOfTheirOwn) {
    const auto spheres = bundled("cornell_spheres");
    expectMotionsToShow(spheres, meshOf(*spheres), kOnReference);
    ASSERT_FALSE(spheres->spheres.empty());
    expectMotionsToShow(spheres, spheres->spheres[0].instance, kOnReference);
    const auto placed = bundled("generate:forest:3");
    ASSERT_FALSE(placed->placements.empty());
    expectMotionsToShow(placed, placed->placements[1].instance, kOnReference);
}

/// A mesh that is moved lies, to the bit, where one lies whose corners were put there.
TEST(SceneChange, AMotionMovesCornersNormalsAndNothingElse) {
    const auto scene = bundled("still_life");
    const uint32_t object = meshOf(*scene);
    const glm::dmat4 motion = glm::scale(
        glm::rotate(shifted(1, 2, 3), 0.75, glm::normalize(glm::dvec3(1, 2, -1))), {2, 3, 0.5});
    const auto moved = changed(scene, motionOf(object, motion));
    const glm::dmat3 linear(motion);
    size_t found = 0;
    for (uint32_t t = 0; t < scene->triangles.size(); ++t) {
        const Triangle &a = scene->triangles[t], &b = moved->triangles[t];
        const bool moves = t >= scene->firstInWorld() && a.instance == object;
        found += moves ? 1 : 0;
        for (size_t c = 0; c < 3; ++c) {
            const glm::vec3 from = scene->positions[a.corner[c]];
            const glm::vec3 to = glm::dvec3(motion * glm::dvec4(glm::dvec3(from), 1));
            EXPECT_EQ(moved->positions[b.corner[c]], moves ? to : from);
            if (a.normals[0] == kNoNormals) continue;
            // Normals stay across the surface: so does what they are across from.
            const glm::dvec3 normal = scene->normals[a.normals[c]],
                             turned = moved->normals[b.normals[c]];
            const glm::dvec3 tangent = glm::normalize(glm::cross(
                normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
            if (moves)
                EXPECT_NEAR(glm::dot(turned, glm::normalize(linear * tangent)), 0, 1e-6);
            else
                EXPECT_EQ(turned, normal);
        }
    }
    EXPECT_GT(found, 0u);
    EXPECT_LT(found, scene->triangles.size());
}

/// What shares its corners with others leaves them where they are.
TEST(SceneChange, SharedCornersStayWithTheOthers) {
    const auto scene = bundled("cornell_boxes");
    const uint32_t object = scene->triangles[0].instance;
    const auto tied = std::make_shared<Scene>(*scene);
    for (size_t t = 0; t < 2; ++t) // two objects with the same two triangles
        tied->triangles.push_back(tied->triangles[t]),
            tied->triangles.back().instance = uint32_t(tied->instances.size());
    tied->instances.emplace_back("twin");
    if (!tied->attributeCorners.empty())
        for (size_t t = 0; t < 2; ++t)
            tied->attributeCorners.push_back(tied->attributeCorners[t]);
    ASSERT_EQ(object, tied->triangles[1].instance);
    const auto moved = changed(tied, motionOf(object, shifted(1, 0, 0)));
    const auto cornerOf = [](const Scene& s, size_t t) {
        return s.positions[s.triangles[t].corner[0]];
    };
    const size_t twin = tied->triangles.size() - 1;
    EXPECT_EQ(cornerOf(*moved, twin), cornerOf(*tied, twin));
    EXPECT_EQ(cornerOf(*moved, 1), cornerOf(*tied, 1) + glm::vec3(1, 0, 0));
}

TEST(SceneChange, RefusesWhatIsNotThereOrCannotBeAndChangesNothing) {
    const auto scene = bundled("cornell_spheres");
    ChangingScene changing(scene);
    const uint32_t sphere = scene->spheres[0].instance, mesh = meshOf(*scene);
    const auto expectRefused = [&](const SceneChange& change, const std::string& words) {
        try {
            changing.apply(change);
            ADD_FAILURE() << words;
        } catch (const std::invalid_argument& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(words));
        }
    };
    glm::dmat4 projective(1), mirror(1), flat(1), infinite(1);
    projective[0][3] = 1;
    mirror[1][1] = -1;
    flat[2][2] = 0;
    infinite[3][0] = std::numeric_limits<double>::infinity();
    for (const glm::dmat4& matrix : {projective, mirror, flat, infinite})
        expectRefused(motionOf(mesh, matrix), "affine matrix");
    expectRefused(motionOf(1000, glm::dmat4(1)), "no instance 1000");
    expectRefused(motionOf(mesh, shifted(0x1p61, 0, 0)), "beyond 2^60");
    expectRefused(motionOf(sphere, glm::scale(glm::dmat4(1), {1, 2, 1})), "alike");
    Light light;
    expectRefused({.materials = {}, .lights = {{1000, light}}, .motions = {}}, "light 1000");
    EXPECT_EQ(changing.scene()->positions, scene->positions);
    EXPECT_TRUE(changing.scene()->movingInstances.empty());
}

/// A view that frames the scene, and fills the picture with it, stays where it is.
TEST(SceneChange, CamerasStayWhereTheyAre) {
    const auto scene = bundled("cornell_spheres");
    scene->cameras.clear();
    scene->cglDialect = false;
    scene->framing.reset();
    RenderSession session(kOnReference);
    session.begin(scene, smallPicture(1));
    const Camera before = session.picture().camera;
    session.change(motionOf(meshOf(*scene), shifted(3, 0, 0)));
    EXPECT_EQ(session.picture().camera.position, before.position);
    EXPECT_EQ(session.picture().camera.halfWidth, before.halfWidth);
}

TEST(SceneChange, BordersOfGridsDoNotMove) {
    const auto scene = bundled("cornell_spheres");
    Medium smoke;
    smoke.absorption = glm::vec3(1);
    smoke.density.emplace();
    scene->media = {Medium{}, smoke};
    const uint32_t object = scene->spheres[0].instance;
    Material& material = scene->materials[scene->spheres[0].material];
    material.boundsMedia = true;
    material.inside = 0;
    EXPECT_NO_THROW(changed(scene, motionOf(object, shifted(1, 0, 0))));
    material.inside = 1;
    EXPECT_THROW(changed(scene, motionOf(object, shifted(1, 0, 0))), std::invalid_argument);
}

/// Trees of what stays are kept, and so are texels: what comes of it is what comes of packing all.
TEST(SceneChange, WhatIsKeptIsWhatWouldBePackedAnew) {
    const auto scene = bundled("still_life");
    const uint32_t object = meshOf(*scene);
    ChangingScene changing(scene);
    const LightSelection lights;
    KeptTrees trees;
    changing.apply(motionOf(object, shifted(0.1, 0, 0)));
    const GpuScene before =
        packScene(*changing.scene(), buildWideBvh(*changing.scene(), {}, &trees), lights);
    const uint64_t built = trees.built();
    EXPECT_GT(built, 0u);
    changing.apply(motionOf(object, glm::rotate(shifted(0.2, 0.1, 0), 1.5, {0, 1, 0})));
    const GpuScene kept = packScene(*changing.scene(), buildWideBvh(*changing.scene(), {}, &trees),
                                    lights, before.lights.environment, kUsualGatheredRows, &before);
    EXPECT_EQ(trees.built(), built) << "the tree of what stays";
    const GpuScene anew = packScene(*changing.scene(), buildWideBvh(*changing.scene()), lights);
    EXPECT_EQ(kept.bvh.records, anew.bvh.records);
    EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(kept.primitives)),
                                   std::as_bytes(std::span(anew.primitives))));
    EXPECT_EQ(kept.materials, anew.materials);
    EXPECT_EQ(kept.details.rows, anew.details.rows);
    EXPECT_EQ(kept.details.firstTexel, anew.details.firstTexel);
    EXPECT_EQ(kept.textureSlots, anew.textureSlots);
    EXPECT_EQ(kept.lights.table, anew.lights.table);
    EXPECT_GT(anew.details.rows.size(), anew.details.firstTexel) << "it has textures";
    EXPECT_NE(before.bvh.records, anew.bvh.records);
}

/// Light samples of a room aim at its window under an even sky, and go where the sky is bright
/// under a small sun.
TEST(SceneChange, PortalsAreForSkiesThatAreEven) {
    Scene room = roomWithWindow(0.8f);
    Estimator estimator;
    estimator.aimsAtPortals = true;
    Environment sky{"", 64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(1)), 1, 0};
    for (const float sun : {1.0f, 1e6f}) {
        sky.radiance[10 * 64 + 5] = glm::vec3(sun);
        room.environment = sky;
        GpuScene packed = packScene(room, buildWideBvh(room));
        fitToPicture(packed, room, kRoomView, estimator);
        EXPECT_EQ(packed.portals.all.size(), sun > 1 ? 0u : 1u);
    }
}

/// A camera that moves asks for no other kernel, whatever its rays visit.
TEST(SceneChange, WhatRaysVisitIsMeasuredOnce) {
    const auto scene = bundled("cornell_mesh");
    GpuScene packed = packScene(*scene, buildWideBvh(*scene));
    const Camera camera = makeCamera(*scene, CameraChoice::Automatic, 4, 4);
    Camera behind = camera;
    behind.position += 100.0 * camera.back;
    behind.back = -camera.back;
    fitToPicture(packed, *scene, behind, {});
    EXPECT_FALSE(packed.ofRay.isKnown()) << "the camera sees nothing";
    fitToPicture(packed, *scene, camera, {});
    const VisitsOfRay visits = packed.ofRay;
    EXPECT_GT(visits.records, 3);
    fitToPicture(packed, *scene, behind, {});
    EXPECT_EQ(packed.ofRay, visits);
    KeptParts kept;
    kept.ofRay.records = 7;
    EXPECT_EQ(buildScene(*scene, {}, {}, &kept).gpu.ofRay, kept.ofRay);
    EXPECT_EQ(buildScene(*scene, {}, {}, nullptr, kUsualGatheredRows, &packed).gpu.ofRay, visits);
}

/// Nor whether its light samples end at walls, which are others for another camera.
TEST(SceneChange, OccludersAreLookedAtAsInTheFirstPicture) {
    const auto scene = bundled("door_ajar");
    const auto built = [&] { return packScene(*scene, buildWideBvh(*scene)); };
    const Camera camera = makeCamera(*scene, CameraChoice::Automatic, 16, 9);
    Camera outside = camera;
    outside.position += 100.0 * camera.back;
    outside.back = -camera.back;
    GpuScene seen = built(), unseen = built();
    fitToPicture(seen, *scene, camera, {});
    EXPECT_TRUE(seen.looksAtOccluders.value());
    EXPECT_FALSE(seen.occluders.all.empty());
    fitToPicture(seen, *scene, outside, {});
    EXPECT_TRUE(seen.looksAtOccluders.value());
    EXPECT_TRUE(seen.occluders.all.empty()) << "the camera sees nothing";
    fitToPicture(unseen, *scene, outside, {});
    EXPECT_FALSE(unseen.looksAtOccluders.has_value());
    fitToPicture(unseen, *scene, camera, {});
    EXPECT_TRUE(unseen.looksAtOccluders.value());
    unseen.looksAtOccluders = false;
    fitToPicture(unseen, *scene, camera, {});
    EXPECT_TRUE(unseen.occluders.all.empty());
    KeptParts kept;
    kept.looksAtOccluders = true;
    EXPECT_TRUE(buildScene(*scene, {}, {}, &kept).gpu.looksAtOccluders.value());
}

TEST(SceneChange, EnvironmentsThatCannotBeAreRefused) {
    Scene lit;
    lit.environment = Environment{};
    SceneChange turn, other;
    turn.rotation = 1.0f;
    other.environment = std::make_shared<Environment>(Environment{"", 2, 1, {{}, {}}, 1, 0});
    EXPECT_THROW(changed(std::make_shared<Scene>(), turn), std::invalid_argument);
    EXPECT_THROW(changed(std::make_shared<Scene>(lit), other), std::invalid_argument);
    EXPECT_EQ(changed(std::make_shared<Scene>(lit), turn)->environment->rotation, 1);
    turn.rotation = INFINITY;
    EXPECT_THROW(changed(std::make_shared<Scene>(lit), turn), std::invalid_argument);
}

TEST(SceneRequests, TurnTheEnvironmentOfTheFile) {
    const TemporaryFolder folder;
    std::ofstream(folder / "sky.xml") << R"(<scene version="0.6.0">
        <emitter type="sky"/><shape type="sphere"/></scene>)";
    SceneRequest request{(folder / "sky.xml").string(), {}, {}};
    const LoadedScene plain = loadScene(request);
    ASSERT_TRUE(plain.scene->environment);
    request.environment.rotationDegrees = 30;
    const LoadedScene turned = loadScene(request);
    EXPECT_EQ(turned.rotationOfFile, plain.scene->environment->rotation);
    EXPECT_FLOAT_EQ(turned.scene->environment->rotation - turned.rotationOfFile, 0.523598776f);
    request.source = "cornell_boxes";
    EXPECT_THROW(loadScene(request), UsageError); // which has none
    std::ofstream(folder / "grey.xml") << R"(<scene version="0.6.0">
        <emitter type="constant"/><shape type="sphere"/></scene>)";
    request.source = (folder / "grey.xml").string();
    EXPECT_THAT(loadScene(request).scene->report.ignored,
                testing::Contains(testing::HasSubstr("same all around")));
}

} // namespace
} // namespace stromboli

// Which lights have a gap into which some bounces are sent, and how wide it is.
#include "host/kernel/gpu_scene.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_features.hpp"
#include "scene/collada/load_collada.hpp"
#include "source_dir.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

namespace stromboli {
namespace {

struct Room {
    float gap = 0.01f, scale = 1;
    float tilt = 0; ///< height of one edge of the light over the other
    bool bothSides = true, facesUp = false;
    MaterialKind ceiling = MaterialKind::Diffuse;
    int lights = 1;
    float skew = 0;         ///< how far a corner of the light is from where a rectangle has it
    float ceilingFrom = -5; ///< x; the light is at 0 to 1
    bool sky = false;
};

void addQuad(Scene& scene, const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b,
             uint32_t material) {
    const auto first = uint32_t(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {corner, corner + a, corner + a + b, corner + b});
    for (const uint32_t second : {1u, 2u}) {
        Triangle t;
        t.corner[0] = first, t.corner[1] = first + second, t.corner[2] = first + second + 1;
        t.material = material;
        scene.triangles.push_back(t);
    }
}

/// A light of 1 x 0.5 below a ceiling.
float gapOf(const Room& room) {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[0].kind = room.ceiling;
    scene.materials[0].albedo = scene.materials[0].reflectance = glm::vec3(0.5f);
    scene.materials[1].emission = glm::vec3(1);
    scene.materials[1].emitsBothSides = room.bothSides;
    scene.materials[2] = scene.materials[1];
    const auto quad = [&](glm::vec3 corner, glm::vec3 a, glm::vec3 b, uint32_t material) {
        addQuad(scene, room.scale * corner, room.scale * a, room.scale * b, material);
    };
    quad({room.ceilingFrom, room.gap, -5}, {10, 0, 0}, {0, 0, 10}, 0);
    // edgeA x edgeB points down, or up.
    const glm::vec3 a(1, room.tilt, 0), b(room.skew, 0, 0.5f);
    for (int light = 0; light < room.lights; ++light)
        room.facesUp ? quad({2.0f * float(light), 0, 0}, b, a, 1 + uint32_t(light))
                     : quad({2.0f * float(light), 0, 0}, a, b, 1 + uint32_t(light));
    if (room.sky) scene.lights.emplace_back().kind = LightKind::Ambient;
    const LightSelection lights = lightSelection(Estimator{});
    return std::abs(packScene(scene, buildWideBvh(scene), lights).gapWidth) / room.scale;
}

TEST(Gap, IsTheDistanceOfTheCeiling) {
    for (const float scale : {1.0f, 1e-12f, 1e-9f, 1e9f, 1e12f})
        for (const float gap : {0.001f, 0.01f, 0.1f})
            for (const bool facesUp : {false, true})
                EXPECT_NEAR(gapOf({.gap = gap, .scale = scale, .facesUp = facesUp}), gap, 1e-5)
                    << scale;
}

TEST(Gap, OfATiltedLightIsTheMedian) {
    EXPECT_NEAR(gapOf({.gap = 0.05f, .tilt = 0.04f}), 0.03, 0.004);
}

TEST(Gap, OnlyOfRectangles) {
    EXPECT_EQ(gapOf({.skew = 0.1f}), 0);
    EXPECT_NEAR(gapOf({.skew = 1e-6f}), 0.01, 1e-5) << "rounding";
}

TEST(Gap, OnlyBelowTheCeiling) {
    EXPECT_NEAR(gapOf({.ceilingFrom = 0.125f}), 0.01, 1e-5) << "7 of 8";
    EXPECT_EQ(gapOf({.ceilingFrom = 0.5f}), 0) << "half";
}

TEST(Gap, OnlyWhereLightComesOutOfIt) {
    EXPECT_EQ(gapOf({.gap = 0.3f}), 0); // wide: bounces find it
    EXPECT_EQ(gapOf({.gap = -0.3f}), 0);
    EXPECT_EQ(gapOf({.ceiling = MaterialKind::Mirror}), 0);
    EXPECT_EQ(gapOf({.lights = 2}), 0);
    EXPECT_EQ(gapOf({.bothSides = false}), 0) << "shines down";
    EXPECT_NEAR(gapOf({.bothSides = false, .facesUp = true}), 0.01, 1e-5) << "shines up";
}

/// A sky that is left to bounces lies before the light in the kernel's buffer.
TEST(Gap, UnderASky) {
    EXPECT_NEAR(gapOf({.gap = 0.05f, .sky = true}), 0.05, 1e-5);
}

TEST(Gap, NotInScenesWithoutOne) {
    const auto folder = std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".dae") continue;
        const Scene scene = loadCollada(entry.path());
        const GpuScene packed = packScene(scene, buildWideBvh(scene));
        const std::string name = entry.path().stem();
        EXPECT_EQ(packed.gapWidth != 0, name == "cornell_boxes" || name == "cornell_mesh") << name;
    }
}

/// The kernel has it only where it can matter.
TEST(Gap, OnlyInKernelsThatNeedIt) {
    const Scene scene = loadCollada(std::filesystem::path(STROMBOLI_SOURCE_DIR) /
                                    "scene/library/cornell_boxes.dae");
    const auto hasGapProposal = [&](const std::function<void(RenderSettings&)>& change) {
        RenderSettings s;
        change(s);
        const GpuScene packed = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
        const Camera camera =
            makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
        return kernelFeatures(packed, camera, s.estimator, {})[SPEC_GAP_PROPOSAL] != 0;
    };
    EXPECT_TRUE(hasGapProposal([](RenderSettings&) {}));
    EXPECT_FALSE(hasGapProposal([](RenderSettings& s) { s.estimator.gapProposal = false; }));
    EXPECT_FALSE(hasGapProposal([](RenderSettings& s) { s.estimator.maxBounces = 1; }));
    EXPECT_FALSE(
        hasGapProposal([](RenderSettings& s) { s.estimator.directLight = DirectLight::Bsdf; }));
    EXPECT_FALSE(
        hasGapProposal([](RenderSettings& s) { s.estimator.integrator = Integrator::Normals; }));
}

} // namespace
} // namespace stromboli

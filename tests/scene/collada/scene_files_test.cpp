// The course's scenes, where they are at hand (../shared/scenes beside the source tree). The
// expected numbers are those of the course's renderer.

#include "host/cs184/cs184.hpp"
#include "tests/scene/collada/document_text.hpp"

#include "scene/model/emitters.hpp"
#include "source_dir.h"
#include "tests/support/cpu_time.hpp"

#include <set>

namespace stromboli::test {
namespace {

const std::filesystem::path kScenes =
    std::filesystem::path(STROMBOLI_SOURCE_DIR) / ".." / "shared" / "scenes";

struct Expected {
    const char* file;
    size_t triangles, spheres, lights, emitters; ///< read in the default mode
    LightKind cs184Light;
    glm::dvec3 target; ///< centre of the bounding box
    double distance;   ///< 1.5 diagonals
};

const Expected kExpected[] = {
    {"meshedit/cow.dae", 5856, 0, 1, 0, LightKind::Directional, {0, -0.0394, -0.0929}, 3.34650},
    {"meshedit/maxplanck.dae", 50801, 0, 1, 0, LightKind::Directional, {0, 0, 0}, 3.60291},
    {"meshedit/teapot.dae", 2464, 0, 1, 0, LightKind::Directional, {0, 0, 0}, 3.03313},
    {"sky/CBbunny.dae", 28588, 0, 0, 1, LightKind::Area, {0, 0.75, 0}, 4.80234},
    {"sky/CBbunny_microfacet_cu.dae", 28588, 0, 0, 1, LightKind::Area, {0, 0.75, 0}, 4.80234},
    {"sky/CBempty.dae", 12, 0, 1, 1, LightKind::Point, {0, 0.75, 0}, 4.80234},
    {"sky/CBspheres.dae", 12, 2, 0, 1, LightKind::Area, {0, 0.75, 0}, 4.80234},
    {"sky/CBspheres_lambertian.dae", 12, 2, 0, 1, LightKind::Area, {0, 0.75, 0}, 4.80234},
    {"sky/CBspheres_microfacet_al_ag.dae", 12, 2, 0, 1, LightKind::Area, {0, 0.75, 0}, 4.80234},
    {"sky/bunny.dae", 33696, 0, 1, 0, LightKind::Ambient, {0, 0.3824, 0}, 3.49528},
};

std::string testName(const testing::TestParamInfo<Expected>& test) {
    return std::filesystem::path(test.param.file).stem().string();
}

class SceneFiles : public testing::TestWithParam<Expected> {
  protected:
    void SetUp() override {
        if (!std::filesystem::exists(kScenes))
            GTEST_SKIP() << "the course's scenes are not at " << kScenes;
    }
    static Scene read(const char* file, bool cs184) {
        return loadCollada(kScenes / file, cs184 ? cs184Conventions() : SceneConventions{});
    }
    static Scene read(bool cs184) { return read(GetParam().file, cs184); }
};

TEST_P(SceneFiles, HasTheExpectedContents) {
    for (bool cs184 : {false, true}) {
        const Scene scene = read(cs184);
        EXPECT_EQ(scene.triangles.size(), GetParam().triangles);
        EXPECT_EQ(scene.spheres.size(), GetParam().spheres);
        EXPECT_EQ(scene.cameras.size(), 1u);
        EXPECT_EQ(scene.report.warnings, std::vector<std::string>{});
        const Bounds bounds = scene.bounds();
        const glm::dvec3 lo = bounds.lo, hi = bounds.hi;
        expectNear((lo + hi) / 2.0, GetParam().target, 1e-4);
        EXPECT_NEAR(1.5 * glm::distance(lo, hi), GetParam().distance, 1e-5);
        EXPECT_EQ(scene.cglDialect, std::string(GetParam().file).starts_with("sky/"));
    }
    const Scene scene = read(false), cs184 = read(true);
    EXPECT_EQ(scene.lights.size(), GetParam().lights);
    EXPECT_EQ(collectEmitters(scene).size(), GetParam().emitters);
    ASSERT_EQ(cs184.lights.size(), 1u);
    EXPECT_EQ(cs184.lights[0].kind, GetParam().cs184Light);
}

TEST_P(SceneFiles, LoadsInNoTime) {
    const double before = test::cpuSeconds();
    read(false);
    EXPECT_LT(test::cpuSeconds() - before, 2) << "0.03 s at most in a release build";
}

INSTANTIATE_TEST_SUITE_P(All, SceneFiles, testing::ValuesIn(kExpected), testName);

class CornellBox : public SceneFiles {};

TEST_P(CornellBox, WallsFaceInwards) {
    const glm::dvec3 center(0, 0.75, 0);
    for (bool cs184 : {false, true}) {
        const Scene scene = read(cs184);
        for (const Triangle& t : scene.triangles) {
            const std::string& name = scene.instances[t.instance];
            // That renderer's emitter faces up; its emission has no side.
            if (name == "bunny" || (cs184 && name == "light")) continue;
            const glm::dvec3 inwards = center - glm::dvec3(scene.positions[t.corner[0]]);
            const glm::dvec3 n = cs184 ? glm::dvec3(scene.normals[t.normals[0]])
                                       : glm::dvec3(scene.geometricNormal(t));
            EXPECT_GT(glm::dot(n, inwards), 0.7) << name;
            if (!cs184) {
                EXPECT_EQ(t.normals[0], kNoNormals) << name << " is flat";
            }
        }
    }
}

TEST_P(CornellBox, TheEmitterIsCountedOnce) {
    const Scene scene = read(false);
    const std::vector<Emitter> emitters = collectEmitters(scene);
    ASSERT_EQ(emitters.size(), 1u);
    EXPECT_EQ(emitters[0].kind, EmitterKind::Quad);
    EXPECT_NEAR(emitters[0].area, 0.48, 1e-6);
    EXPECT_EQ(scene.materials[emitters[0].material].emission, glm::vec3(10));
    expectNear(glm::normalize(glm::cross(emitters[0].edgeA, emitters[0].edgeB)), {0, -1, 0}, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(All, CornellBox,
                         testing::Values(kExpected[5], kExpected[6], kExpected[7], kExpected[8]),
                         testName);

class SingleFiles : public SceneFiles {};

TEST_F(SingleFiles, LambertianSpheresHaveTheDocumentedLight) {
    const Scene scene = read("sky/CBspheres_lambertian.dae", true);
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.color, glm::vec3(10));
    expectNear(light.position, {0, 1.49, 0});
    expectNear(light.direction, {0, -1, 0});
    expectNear(glm::abs(light.edgeX), {0.6, 0, 0});
    expectNear(glm::abs(light.edgeY), {0, 0, 0.8});
    ASSERT_EQ(scene.spheres.size(), 2u);
    expectNear(scene.spheres[0].center, {0.4, 0.3, 0.3});
    EXPECT_FLOAT_EQ(scene.spheres[0].radius, 0.3f);
}

TEST_F(SingleFiles, TheCowsLightIsAimedAsAPoint) {
    expectNear(-read("meshedit/cow.dae", true).lights.at(0).direction, {-0.4706, 0.7463, 0.4706},
               1e-4);
    expectNear(-read("meshedit/cow.dae", false).lights.at(0).direction, {-0.5, 0.7071, 0.5}, 1e-4);
}

TEST_F(SingleFiles, MaterialsOfTheSpheres) {
    const Scene scene = read("sky/CBspheres.dae", false);
    std::set<MaterialKind> kinds;
    for (const Sphere& s : scene.spheres)
        kinds.insert(scene.materials[s.material].kind);
    EXPECT_EQ(kinds, (std::set{MaterialKind::Mirror, MaterialKind::Dielectric}));
    const Scene metals = read("sky/CBspheres_microfacet_al_ag.dae", false);
    for (const Sphere& s : metals.spheres)
        EXPECT_EQ(metals.materials[s.material].kind, MaterialKind::Conductor);
}

TEST_F(SingleFiles, MaxPlancksBoundaryIsMostlyFlipped) {
    const Scene scene = read("meshedit/maxplanck.dae", true);
    std::vector<glm::dvec3> sums(scene.positions.size(), glm::dvec3(0));
    std::vector<uint32_t> normals(scene.positions.size());
    std::set<std::pair<uint32_t, uint32_t>> edges;
    for (const Triangle& t : scene.triangles)
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                             c = scene.positions[t.corner[2]];
            sums[t.corner[i]] += glm::cross(b - a, c - a);
            normals[t.corner[i]] = t.normals[i];
            edges.insert({t.corner[i], t.corner[(i + 1) % 3]});
        }
    std::set<uint32_t> boundary;
    for (const auto& [from, to] : edges)
        if (!edges.contains({to, from})) boundary.insert({from, to});
    EXPECT_EQ(boundary.size(), 87u);
    int flipped = 0;
    for (uint32_t v : boundary)
        flipped += glm::dot(glm::dvec3(scene.normals[normals[v]]), sums[v]) < 0;
    EXPECT_EQ(flipped, 83);
}

} // namespace
} // namespace stromboli::test

// Scenes made in memory: the library's file without the rounding of its text, and larger ones.
#include "host/core/error.hpp"
#include "host/cs184/cs184.hpp"
#include "scene/camera/camera.hpp"
#include "scene/generate/generated_scene.hpp"
#include "scene/read_scene.hpp"
#include "source_dir.h"
#include "tests/support/test_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

namespace stromboli {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kFile = STROMBOLI_SOURCE_DIR "/scene/library/cornell_mesh.dae";

std::string messageOf(const std::string& source, const SceneConventions& conventions = {}) {
    try {
        readScene(source, conventions);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

/// Positions in the file are rounded to 0.1 mm; then both are rounded to float, below 2 m.
constexpr float kPositionRounding = 0.05e-3f + 0x1p-23f;
/// Normals in the file are rounded to three digits in each coordinate: 0.0005 sqrt(3) in all, and
/// scaling back to length 1 at most doubles that.
constexpr float kNormalRounding = 0.0018f;

class InMemory : public testing::Test {
  protected:
    Scene made_ = readScene("generate:cornell_mesh:50000"), read_ = readScene(kFile);
};

TEST_F(InMemory, TrianglesAreTheFilesInTheSameOrder) {
    ASSERT_EQ(made_.triangles.size(), read_.triangles.size());
    EXPECT_EQ(made_.positions.size(), read_.positions.size());
    EXPECT_TRUE(made_.spheres.empty());
    size_t flat = 0; // in the file: the rounding has made the three normals one
    for (size_t i = 0; i < made_.triangles.size(); ++i) {
        const Triangle &a = made_.triangles[i], &b = read_.triangles[i];
        ASSERT_EQ(made_.materials[a.material].name, read_.materials[b.material].name);
        ASSERT_EQ(made_.instances[a.instance], read_.instances[b.instance]);
        flat += a.normals[0] != kNoNormals && b.normals[0] == kNoNormals;
        for (int c = 0; c < 3; ++c) {
            const glm::vec3 apart = made_.positions[a.corner[c]] - read_.positions[b.corner[c]];
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_LE(std::abs(apart[axis]), kPositionRounding) << i;
            if (b.normals[c] == kNoNormals) continue;
            ASSERT_LE(glm::distance(made_.normals[a.normals[c]], read_.normals[b.normals[c]]),
                      kNormalRounding)
                << i;
        }
    }
    EXPECT_EQ(flat, 0u);
}

TEST_F(InMemory, MaterialsAreTheFiles) {
    EXPECT_EQ(made_.instances, read_.instances);
    ASSERT_EQ(made_.materials.size(), read_.materials.size());
    for (size_t i = 0; i < made_.materials.size(); ++i) {
        const Material &a = made_.materials[i], &b = read_.materials[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.kind, b.kind);
        EXPECT_EQ(a.albedo, b.albedo);
        EXPECT_EQ(a.emission, b.emission);
        EXPECT_EQ(a.emitsBothSides, b.emitsBothSides);
    }
    EXPECT_EQ(made_.lights.size(), read_.lights.size());
}

TEST_F(InMemory, CameraIsTheFiles) {
    ASSERT_EQ(made_.cameras.size(), 1u);
    ASSERT_EQ(read_.cameras.size(), 1u);
    const FileCamera &a = made_.cameras[0], &b = read_.cameras[0];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.projection, b.projection);
    EXPECT_EQ(a.halfWidth, b.halfWidth);
    EXPECT_EQ(a.halfHeight, b.halfHeight);
    EXPECT_EQ(a.nearDistance, b.nearDistance);
    EXPECT_EQ(a.farDistance, b.farDistance);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.right, b.right);
    EXPECT_EQ(a.up, b.up);
    EXPECT_EQ(a.back, b.back);
    EXPECT_EQ(a.pointAhead, b.pointAhead);
    EXPECT_EQ(made_.cglDialect, read_.cglDialect);
    const Bounds framedMade = made_.framing.value_or(made_.bounds());
    const Bounds framedRead = read_.framing.value_or(read_.bounds());
    EXPECT_EQ(framedMade.lo, framedRead.lo); // those of the walls, which are not rounded
    EXPECT_EQ(framedMade.hi, framedRead.hi);
}

TEST_F(InMemory, NothingIsReported) {
    EXPECT_TRUE(made_.report.ignored.empty());
    EXPECT_TRUE(made_.report.warnings.empty());
    EXPECT_EQ(made_.file, "generate:cornell_mesh:50000");
}

TEST(GeneratedScene, IsTheSameEveryTime) {
    const Scene a = generatedScene("cornell_mesh:20000"), b = generatedScene("cornell_mesh:20000");
    EXPECT_TRUE(a.positions == b.positions);
    EXPECT_TRUE(a.normals == b.normals);
    EXPECT_TRUE(std::equal(a.triangles.begin(), a.triangles.end(), b.triangles.begin(),
                           b.triangles.end(), [](const Triangle& s, const Triangle& t) {
                               return std::equal(s.corner, s.corner + 3, t.corner) &&
                                      std::equal(s.normals, s.normals + 3, t.normals) &&
                                      s.material == t.material && s.instance == t.instance;
                           }));
}

/// What a loaded scene promises holds for those of any size: numbers in range, unit normals,
/// triangles that have an area and face the side of their normals; and the knot is closed.
class OfSize : public testing::TestWithParam<uint32_t> {};

TEST(MadeScenes, SizesMayBeWrittenInThousands) {
    EXPECT_EQ(readScene("generate:cornell_mesh:2.5k").triangles.size(),
              readScene("generate:cornell_mesh:2500").triangles.size());
    EXPECT_EQ(readScene("generate:lamps:4e1").triangles.size(),
              readScene("generate:lamps:40").triangles.size());
}

TEST_P(OfSize, KeepsThePromisesOfALoadedScene) {
    const uint32_t wanted = GetParam();
    const Scene s = readScene("generate:cornell_mesh:" + std::to_string(wanted));
    const size_t walls = 12;
    EXPECT_NEAR(double(s.triangles.size() - walls), wanted, 0.01 * wanted);
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t i = 0; i < s.triangles.size(); ++i) {
        const Triangle& t = s.triangles[i];
        glm::dvec3 p[3], normals(0);
        for (int c = 0; c < 3; ++c) {
            ASSERT_LT(t.corner[c], s.positions.size());
            p[c] = s.positions[t.corner[c]];
        }
        const glm::dvec3 face = glm::cross(p[1] - p[0], p[2] - p[0]);
        ASSERT_GT(glm::length(face), 0);
        if (i < walls) continue;
        for (int c = 0; c < 3; ++c) {
            ASSERT_LT(t.normals[c], s.normals.size());
            normals += glm::dvec3(s.normals[t.normals[c]]);
            ++edges[std::minmax(t.corner[c], t.corner[(c + 1) % 3])];
        }
        ASSERT_GT(glm::dot(face, normals), 0) << i;
    }
    for (const auto& [edge, count] : edges)
        ASSERT_EQ(count, 2);
    for (const glm::vec3& n : s.normals)
        ASSERT_NEAR(glm::length(n), 1, 0x1p-22);
    const Bounds b = s.bounds();
    EXPECT_EQ(b.lo, glm::vec3(-1));
    EXPECT_EQ(b.hi, glm::vec3(1));
}

INSTANTIATE_TEST_SUITE_P(Sizes, OfSize, testing::Values(1000, 1001, 3456, 200'000),
                         test::NamedByValue{});

TEST(GeneratedScene, WrongNamesAreOneClearError) {
    for (const char* name : {"",
                             "cornell_mesh",
                             "cornell_mesh:",
                             "cornell_mesh:many",
                             "cornell_mesh:1000.5",
                             "cornell_mesh: 5000",
                             "cornell_mesh:-5000",
                             "cornell_mesh:5000:",
                             "cornell_mesh:999",
                             "cornell_mesh:100000001",
                             "cornell_mesh:99999999999",
                             "cornell_box:5000",
                             "Cornell_mesh:5000",
                             "cornell_mesh:1e9",
                             "lamps:",
                             "lamps:7",
                             "lamps:100",
                             "lamps:8000008",
                             "points:0",
                             "points:8000001"})
        EXPECT_THAT(messageOf(std::string("generate:") + name),
                    AllOf(testing::StartsWith(std::string("generate:") + name + ": no such scene"),
                          HasSubstr("generate:cornell_mesh:N with N from 1000 to 100000000")));
    EXPECT_THAT(messageOf("generate:cornell_mesh:5000", cs184Conventions()), HasSubstr("--cs184"));
}

TEST(GeneratedScene, EmittersAreSpreadThroughARoom) {
    const Scene scene = generatedScene("lamps:800");
    size_t emitters = 0;
    double sum = 0;
    for (const Triangle& t : scene.triangles) {
        if (!scene.materials[t.material].emits()) continue;
        ++emitters;
        const glm::vec3 a = scene.positions[t.corner[0]];
        sum += a.x;
        EXPECT_LT(std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}), 1.0f);
    }
    EXPECT_EQ(emitters, 800u);
    EXPECT_EQ(scene.triangles.size(), emitters + 10); // the walls
    // Uniform in [-.95, .95], 8 triangles an emitter: deviation .055.
    EXPECT_NEAR(sum / 800, 0, 0.25);
}

TEST(GeneratedScene, PointsDifferAMillionfold) {
    const Scene scene = generatedScene("points:1000");
    ASSERT_EQ(scene.lights.size(), 1000u);
    float least = 1, most = 0;
    for (const Light& light : scene.lights) {
        EXPECT_EQ(light.kind, LightKind::Point);
        least = std::min(least, light.color.x), most = std::max(most, light.color.x);
    }
    EXPECT_GT(most / least, 9e5f);
    EXPECT_EQ(scene.triangles.size(), 10u); // the walls
}

TEST(GeneratedScene, AnythingElseIsAFile) {
    EXPECT_THAT(messageOf("generate"), testing::StartsWith("generate: "));
    EXPECT_THAT(messageOf("./generate:cornell_mesh:5000"),
                testing::Not(HasSubstr("no such scene")));
}

} // namespace
} // namespace stromboli

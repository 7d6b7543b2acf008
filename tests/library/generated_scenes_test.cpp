#include "scene/generate/collada_text.hpp"
#include "scene/generate/cornell_mesh.hpp"
#include "scene/generate/gnarled_knot.hpp"
#include "scene/generate/island.hpp"
#include "scene/generate/terrain.hpp"
#include "source_dir.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

namespace stromboli {
namespace {

using Edge = std::pair<uint32_t, uint32_t>;
using Corners = std::array<uint32_t, 3>;

std::vector<Corners> trianglesOf(const StripMesh& mesh) {
    std::vector<Corners> triangles;
    for (const auto& [material, strips] : mesh.strips)
        for (const Strip& s : strips)
            for (size_t i = 2; i < s.size(); ++i)
                triangles.push_back(i % 2 ? Corners{s[i - 1], s[i - 2], s[i]}
                                          : Corners{s[i - 2], s[i - 1], s[i]});
    return triangles;
}

/// Every triangle faces the side its normals point to.
void expectFacesItsNormals(const StripMesh& mesh) {
    ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
    for (const Corners& t : trianglesOf(mesh)) {
        const glm::dvec3 a = mesh.positions[t[0]];
        const glm::dvec3 face = glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
        const glm::dvec3 smooth = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
        ASSERT_GT(glm::dot(face, smooth), 0) << t[0] << " " << t[1] << " " << t[2];
    }
}

/// How often each directed edge occurs.
std::map<Edge, int> edgesOf(const StripMesh& mesh) {
    std::map<Edge, int> edges;
    for (const Corners& t : trianglesOf(mesh))
        for (int i = 0; i < 3; ++i)
            ++edges[{t[i], t[(i + 1) % 3]}];
    return edges;
}

TEST(GeneratedScenes, TheKnotIsClosedAndFacesOutwards) {
    const StripMesh knot = gnarledKnot(500, 50, "clay");
    EXPECT_EQ(knot.triangleCount(), 50'000u);
    expectFacesItsNormals(knot);
    const std::map<Edge, int> edges = edgesOf(knot);
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        ASSERT_TRUE(edges.contains({edge.second, edge.first}));
    }
    double sixVolumes = 0;
    for (const Corners& t : trianglesOf(knot))
        sixVolumes +=
            glm::dot(knot.positions[t[0]], glm::cross(knot.positions[t[1]], knot.positions[t[2]]));
    EXPECT_GT(sixVolumes, 0);
}

TEST(GeneratedScenes, TheIslandIsOneSheetFacingUp) {
    const StripMesh island = volcanoIsland(322);
    expectFacesItsNormals(island);
    for (const glm::dvec3& normal : island.normals)
        ASSERT_GT(normal.z, 0);
    for (const auto& [edge, count] : edgesOf(island))
        ASSERT_EQ(count, 1);
}

TEST(GeneratedScenes, NumbersAreCompact) {
    EXPECT_EQ(compactNumber(12.340, 3), "12.34");
    EXPECT_EQ(compactNumber(100, 0), "100");
    EXPECT_EQ(compactNumber(100, 1), "100");
    EXPECT_EQ(compactNumber(-0.04, 1), "0");
    EXPECT_EQ(compactNumber(-0.06, 1), "-0.1");
}

/// If this fails after a change to scene/generate: stromboli_generate_scenes scene/library
TEST(GeneratedScenes, BundledFilesAreWhatTheGeneratorWrites) {
    const std::filesystem::path library = STROMBOLI_SOURCE_DIR "/scene/library";
    const auto contentOf = [&](const char* name) {
        std::ifstream file(library / name, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    EXPECT_TRUE(contentOf("cornell_mesh.dae") == cornellMeshText(cornellMesh(500, 50)));
    EXPECT_TRUE(contentOf("island.dae") == islandScene());
}

} // namespace
} // namespace stromboli

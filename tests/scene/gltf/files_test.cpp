// Files that other programs wrote: Khronos' sample models where they lie beside the checkout, and
// those of Debian's package assimp-testmodels.

#include "source_dir.h"
#include "tests/scene/gltf/gltf_text.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace stromboli::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

const fs::path kSamples = fs::path(STROMBOLI_SOURCE_DIR) / ".." / "shared" / "peers" / "gltf";
const fs::path kAssimp = "/usr/share/assimp/models/glTF2";

std::vector<fs::path> filesBelow(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

TEST(GltfFiles, SamplesLoad) {
    if (!fs::exists(kSamples)) GTEST_SKIP() << kSamples << " is not there";
    SceneConventions conventions;
    conventions.selection.largestTexture = 64; // large pictures are decoded and not kept
    for (const fs::path& file : filesBelow(kSamples)) {
        const Scene scene = loadGltf(file, conventions);
        EXPECT_GT(scene.triangles.size(), 0u) << file;
        for (const VertexAttributes& a : scene.attributes)
            ASSERT_TRUE(std::isfinite(a.uv[0].x + a.uv[1].y + a.color.w + a.tangent.x)) << file;
    }
}

/// Its meshes state tangents, on mirrored pictures too: those that are computed are the same.
TEST(GltfFiles, ComputedTangentsAreThoseOfTheSample) {
    const fs::path file =
        kSamples / "NormalTangentMirrorTest/glTF-Binary/NormalTangentMirrorTest.glb";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    SceneConventions conventions;
    conventions.selection.largestTexture = 64;
    const Scene stated = loadGltf(file, conventions);
    // Without its tangents: another name, of the same length, is no attribute that is read.
    std::ifstream in(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), {});
    size_t count = 0;
    for (size_t at; (at = bytes.find("\"TANGENT\"")) != std::string::npos; ++count)
        bytes.replace(at, 9, "\"TANG_NT\"");
    ASSERT_GT(count, 0u);
    const Scene computed = loadGltfBytes(bytes, conventions);
    ASSERT_EQ(stated.triangles.size(), computed.triangles.size());
    size_t compared = 0, close = 0, sameSense = 0;
    for (size_t t = 0; t < stated.triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            const glm::vec4 a = stated.attributes[stated.attributeCorners[t][i]].tangent;
            const glm::vec4 b = computed.attributes[computed.attributeCorners[t][i]].tangent;
            ++compared;
            close += glm::dot(glm::vec3(a), glm::vec3(b)) > 0.99f;
            sameSense += a.w == b.w;
        }
    // Programs differ at poles and seams of the spheres.
    EXPECT_GT(double(close), 0.97 * double(compared));
    EXPECT_GT(double(sameSense), 0.99 * double(compared));
}

TEST(GltfFiles, PackedAndQuantisedDucksAreAlike) {
    const fs::path packed = kSamples / "Duck/glTF-Draco/Duck.gltf";
    if (!fs::exists(packed)) GTEST_SKIP() << packed << " is not there";
    const Scene a = loadGltf(packed), b = loadGltf(kSamples / "Duck/glTF-Quantized/Duck.gltf");
    EXPECT_EQ(a.triangles.size(), b.triangles.size());
    const Bounds x = a.bounds(), y = b.bounds();
    // Both have about eleven bits a coordinate.
    const float step = glm::length(x.extent()) / 1024;
    EXPECT_LT(glm::distance(x.lo, y.lo), step);
    EXPECT_LT(glm::distance(x.hi, y.hi), step);
}

TEST(GltfFiles, AssimpsModelsLoadOrSayWhatIsWrong) {
    if (!fs::exists(kAssimp)) GTEST_SKIP() << "the package assimp-testmodels is not installed";
    const std::map<std::string, std::string> wrong = {
        {"AllIndicesOutOfRange.gltf", "indices>: has the index 65535"},
        {"IndexOutOfRange.gltf", "indices>: has the index 255"},
        {"RecursiveNodes.gltf", "is on a circle of parents and children"},
        {"sceneWrongType.gltf", "<scene>: is no number"},
        {"badArray.gltf", "<meshes[0].primitives>: is no array"},
        {"badExtension.gltf", "KHR_texture_transform>: is no object"},
        {"badNumber.gltf", "<materials[0].normalTexture.index>: is not there"},
        {"badObject.gltf", "pbrMetallicRoughness>: is no object"},
        {"badUint.gltf", "index>: is -1, expected a whole number"},
    };
    for (const fs::path& file : filesBelow(kAssimp)) {
        std::string expected;
        const auto found = wrong.find(file.filename().string());
        if (found != wrong.end()) expected = found->second;
        if (file.parent_path().filename() == "MissingBin")
            expected = "cannot be opened for reading";
        if (file.parent_path().filename() == "BoxTextured-glTF-techniqueWebGL")
            expected = "the file requires 'KHR_technique_webgl'";
        std::string error, forgiven;
        try {
            for (const std::string& line : loadGltf(file).report.forgiven)
                forgiven += line + "\n";
        } catch (const SceneError& thrown) {
            error = thrown.what();
        }
        if (expected.empty())
            EXPECT_EQ(error, "") << file;
        else
            EXPECT_THAT(error + forgiven, HasSubstr(expected)) << file;
    }
}

} // namespace
} // namespace stromboli::test

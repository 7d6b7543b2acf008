// Damaged files end in a scene or a SceneError: never in a crash, a hang or another exception.
// Fixed seeds; worth running with STROMBOLI_SANITIZE=address,undefined.

#include "tests/scene/ply/ply_text.hpp"

#include <cmath>
#include <random>

namespace stromboli::test {
namespace {

/// One of everything.
std::string everything(const std::string& format) {
    std::string bytes = plyHeader(
        format,
        "property float nx\nproperty float ny\nproperty float nz\nproperty float s\n"
        "property float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "property list uchar short extra\n",
        "element other 2\nproperty int a\nelement face 2\nproperty list uchar int vertex_indices\n"
        "property char flag\nelement tristrips 1\nproperty list int int vertex_indices\n");
    if (format == "ascii")
        return bytes + "0 0 0 0 0 1 0 0 255 0 0 0\n1 0 0 0 0 1 1 0 0 255 0 2 7 8\n"
                       "1 1 0 0 0 1 1 1 0 0 255 0\n0 1 0 0 0.6 0.8 0 1 9 9 9 0\n1\n2\n"
                       "4 0 1 2 3 1\n3 0 1 2 -1\n6 0 1 3 2 -1 0\n";
    const bool big = format == "binary_big_endian";
    for (int i = 0; i < 4; ++i) {
        const float numbers[] = {float(i % 2), float(i / 2), 0, 0, 0.6f, 0.8f, 0.5f, 0.25f};
        for (const float number : numbers)
            bytes += plyBytes(number, big);
        bytes += std::string("\x10\x20\x30\x01", 4) + plyBytes(int16_t(5), big);
    }
    const auto ints = [&](std::initializer_list<int32_t> values) {
        for (const int32_t value : values)
            bytes += plyBytes(value, big);
    };
    ints({1, 2});
    bytes += '\x04';
    ints({0, 1, 3, 2});
    bytes += "\x01\x03";
    ints({0, 1, 2});
    bytes += '\x02';
    ints({6, 0, 1, 2, 3, -1, 0});
    return bytes;
}

void expectSound(const Scene& scene) {
    for (const Triangle& t : scene.triangles)
        for (int k = 0; k < 3; ++k) {
            ASSERT_LT(t.corner[k], scene.positions.size());
            ASSERT_TRUE(t.normals[k] == kNoNormals || t.normals[k] < scene.normals.size());
        }
    for (const VertexAttributes& a : scene.attributes)
        ASSERT_TRUE(std::isfinite(a.uv[0].x + a.uv[0].y + a.color.x + a.color.w));
}

std::string mutated(std::string bytes, std::mt19937& random) {
    const char* const words[] = {
        " -1 ",   " 4294967295 ",  " 9223372036854775807 ",        " nan ", "\n",
        " 1e99 ", "element x 3\n", "property list uchar uint y\n", " 0 "};
    for (unsigned k = 0; k <= random() % 3; ++k) {
        const size_t at = random() % bytes.size();
        switch (random() % 4) {
        case 0:
            bytes[at] ^= char(1u << (random() % 8));
            break;
        case 1:
            bytes.insert(at, words[random() % std::size(words)]);
            break;
        case 2:
            bytes.erase(at, 1 + random() % 10);
            break;
        default:
            bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 40));
        }
        if (bytes.empty()) bytes = "p";
    }
    return bytes;
}

class PlyMutations : public testing::TestWithParam<const char*> {};

TEST_P(PlyMutations, EndInASceneOrAnError) {
    std::mt19937 random(4);
    const std::string original = everything(GetParam());
    EXPECT_EQ(loadPlyBytes(original).triangles.size(), 5u);
    int scenes = 0, errors = 0;
    for (int i = 0; i < 2000; ++i) {
        try {
            expectSound(loadPlyBytes(mutated(original, random)));
            ++scenes;
        } catch (const SceneError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            ++errors;
        }
    }
    EXPECT_GT(scenes, 100);
    EXPECT_GT(errors, 200);
}

INSTANTIATE_TEST_SUITE_P(Formats, PlyMutations,
                         testing::Values("ascii", "binary_little_endian", "binary_big_endian"),
                         [](const auto& parameter) { return std::string(parameter.param); });

} // namespace
} // namespace stromboli::test

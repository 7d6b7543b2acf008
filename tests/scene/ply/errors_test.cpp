// Wrong files, with the message each gives.

#include "tests/scene/ply/ply_text.hpp"

namespace stromboli::test {
namespace {

using testing::HasSubstr;

TEST(PlyErrors, NameFileAndLine) {
    const std::string header = plyHeader("ascii"); // ten lines
    const std::pair<std::string, std::string> cases[] = {
        {"", "p.ply:1: is no PLY file"},
        {"ply\nformat ascii 1.0\n", "p.ply:3: the file ends within the header"},
        {"ply\nformat text 1.0\nend_header\n", "p.ply:2: the format is 'text', expected ascii"},
        {"ply\nelement vertex -1\n", "p.ply:2: expected 'element NAME COUNT'"},
        {"ply\nproperty float x\n", "p.ply:2: there is no element before this property"},
        {"ply\nelement a 1\nproperty real x\n", "p.ply:3: 'real' is no type"},
        {"ply\nelement a 1\nproperty list float int x\n", "no floating-point number"},
        {"ply\nelement a 1\nelement a 1\n", "there is an element 'a' already"},
        {"ply\nelement vertex 0\nend_header\n", "without a line 'format'"},
        {"ply\nformat ascii 1.0\nend_header\n", "the header has no element 'vertex'"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n1\n",
         "vertices have no x, y and z"},
        {header + kPlySquare + "3 0 1 4\n", "p.ply:15: <face[0]>: names vertex 4, but there are 4"},
        {header + kPlySquare + "3 0 1 -1\n", "names vertex -1"},
        {header + kPlySquare + "3 0 1 1.5\n", "names vertex 1.5"},
        {header + kPlySquare + "3 0 1\n", "p.ply:16: <face[0]>: the file ends"},
        {header + kPlySquare + "-3 0 1 2\n", "the length of the list 'vertex_indices' is -3"},
    };
    for (const auto& [text, message] : cases)
        EXPECT_THAT(plyErrorOf(text), HasSubstr(message)) << text;
}

TEST(PlyErrors, VerticesThatAreNoPointsCostTheirTriangles) {
    for (const char* word : {"nan", "zero"}) {
        const Scene scene =
            loadPlyBytes(plyHeader("ascii") + "0 0 0\n1 0 " + word + "\n1 1 0\n0 1 0\n3 0 2 3\n");
        EXPECT_EQ(scene.triangles.size(), 1u) << word; // no face names the vertex
        EXPECT_EQ(scene.report.forgiven.size(), word[0] == 'z') << word;
    }
}

TEST(PlyErrors, OneFaceCostsItself) {
    std::string header = plyHeader("ascii");
    header.replace(header.find("element face 1"), 14, "element face 3");
    const std::string text = header + kPlySquare + "3 0 1 2\n3 0 1 7\n3 0 2 3\n";
    const Scene scene = loadPlyBytes(text);
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_THAT(scene.report.forgiven, testing::ElementsAre(HasSubstr("names vertex 7")));
    SceneConventions strict;
    strict.strict = true;
    EXPECT_THROW(loadPlyBytes(text, strict), SceneError);
}

TEST(PlyErrors, OfBinaryFilesNameTheElement) {
    const std::string floats(12 * 4, '\0');
    const std::string header = plyHeader("binary_little_endian");
    EXPECT_THAT(
        plyErrorOf(header + floats + "\x03" + std::string(8, '\0') + "\x09" + std::string(3, '\0')),
        HasSubstr("p.ply: <face[0]>: names vertex 9, but there are 4"));
    EXPECT_THAT(plyErrorOf(header + floats + "\x03" + std::string(8, '\0')),
                HasSubstr("the list 'vertex_indices' has 3 numbers, but 8 bytes are left"));
}

/// No memory is taken for what cannot be there.
TEST(PlyErrors, HugeCounts) {
    for (const char* format : {"ascii", "binary_little_endian"})
        for (const char* count : {"1000000000", "4294967295", "9223372036854775807"}) {
            std::string header = plyHeader(format);
            header.replace(header.find("vertex 4") + 7, 1, count);
            EXPECT_THAT(plyErrorOf(header + kPlySquare), HasSubstr("p.ply: <vertex"));
            header = plyHeader(format);
            header.replace(header.find("face 1") + 5, 1, count);
            EXPECT_THAT(plyErrorOf(header + std::string(48, '0')),
                        HasSubstr(format[0] == 'a' ? "p.ply" : "p.ply: <face>: the header says"));
        }
    EXPECT_THAT(plyErrorOf(plyHeader("ascii", "",
                                     "element face 1\nproperty list uint int vertex_indices\n") +
                           kPlySquare + "4000000000 0 1 2\n"),
                HasSubstr("has 4000000000 numbers, but 7 bytes are left"));
}

} // namespace
} // namespace stromboli::test

// Which files URIs stand for, and that none lies outside the folder.

#include "tests/scene/gltf/forgiven.hpp"

#include <filesystem>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

TEST(GltfErrors, UrisStayInTheFolder) {
    for (const char* uri : {"../a.bin", "b/../../a.bin", "%2e%2e/a.bin", "/etc/passwd",
                            "%2Fetc/passwd", "..%5Ca.bin", "a.bin%00"}) {
        GltfText g = triangle();
        g.arrays["buffers"] = {fmt::format(R"({{"byteLength": 36, "uri": "{}"}})", uri)};
        EXPECT_EQ(problem(g),
                  fmt::format("<buffers[0]>: the URI '{}' leads out of the file's folder", uri));
    }
    for (const char* uri : {"file:///etc/passwd", "http://a.org/a.bin", "C:a.bin"}) {
        GltfText g = triangle();
        g.arrays["buffers"] = {fmt::format(R"({{"byteLength": 36, "uri": "{}"}})", uri)};
        EXPECT_EQ(problem(g),
                  fmt::format("<buffers[0]>: the URI '{}' is no relative path; only files are read",
                              uri));
    }
}

/// The buffer lies in `there`; `uri` names it.
void expectFound(const std::string& there, const std::string& uri, const std::string& said = "") {
    const Folder folder;
    std::filesystem::create_directories((folder.path() / there).parent_path());
    std::filesystem::create_directories(folder.path() / "sub");
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    folder.write(there, {reinterpret_cast<const char*>(points.data()), 36});
    GltfText g = triangle();
    g.arrays["buffers"] = {fmt::format(R"({{"byteLength": 36, "uri": "{}"}})", uri)};
    const Scene scene = loadGltf(folder.write("scene.gltf", g.text()));
    EXPECT_EQ(scene.triangles.size(), 1u) << uri;
    EXPECT_EQ(scene.report.forgiven.empty(), said.empty()) << uri;
    if (!said.empty()) {
        EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr(said)));
    }
}

TEST(GltfUris, AreReadAsTheyAreMeant) {
    expectFound("sub/a.bin", "sub/a.bin");
    expectFound("a.bin", "sub/../a.bin");
    expectFound("a.bin", "./sub/.././a.bin");
    expectFound("a b.bin", "a%20b.bin");
    expectFound("a b.bin", "a b.bin");
    expectFound("50%20.bin", "50%20.bin"); // a percent sign that was not encoded
    expectFound("sub/a.bin", R"(sub\\a.bin)", "they are read as slashes");
    expectFound("sub/a.bin", "sub%5Ca.bin", "they are read as slashes");
    expectFound("Sub/A.bin", "sUB/a.BIN", "the file with other capitals is taken");
    expectFound("a.bin", "../a.bin", "the file of the same name beside it is taken");
    expectFound("a.bin", R"(C:\\models\\a.bin)", "the file of the same name beside it is taken");
    expectFound("a.bin", "file:///home/me/a.bin", "the file of the same name beside it is taken");
    expectFound("a b.bin", "./a%20b.bin?v=3", "the name before it is read");
    expectFound("a?b.bin", "a%3Fb.bin");
    expectFound("a.jpg", "a.ktx2", "with another ending is taken");
    expectFound("a#b.bin", "a#b.bin");
}

TEST(GltfUris, MayHaveNamesThatAreNoUtf8) {
    expectFound("caf\xE9.bin", "caf\xE9.bin", "they are read as characters of Latin-1");
    expectFound("caf\xE9.bin", "caf%E9.bin");
    expectFound("caf\xC3\xA9.bin", "caf%E9.bin", "it is read so");
    GltfText g = triangle();
    g.arrays["nodes"][0] = "{\"mesh\": 0, \"name\": \"caf\xE9 \xFF\"}";
    expectForgiven(g, "has bytes that are no UTF-8", "they are read as characters of Latin-1");
}

TEST(GltfErrors, LinksStayInTheFolder) {
    const Folder inside, outside;
    GltfText g = triangle();
    g.arrays["buffers"] = {R"({"byteLength": 36, "uri": "my%20buffer.bin"})"};
    const std::filesystem::path file = inside.write("scene.gltf", g.text());
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::string_view bytes(reinterpret_cast<const char*>(points.data()), 36);
    outside.write("secret.bin", bytes);
    std::filesystem::create_symlink(outside.path() / "secret.bin", inside.path() / "my buffer.bin");
    try {
        loadGltf(file);
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(), HasSubstr("is a link out of the file's folder"));
    }
    std::filesystem::remove(inside.path() / "my buffer.bin");
    inside.write("my buffer.bin", bytes);
    EXPECT_EQ(loadGltf(file).triangles.size(), 1u);
}

} // namespace
} // namespace stromboli::test

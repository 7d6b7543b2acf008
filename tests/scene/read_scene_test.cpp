// Which loader reads what: told by the file's name, and where that says nothing, by its content.

#include "host/cs184/cs184.hpp"
#include "scene/find_scene.hpp"
#include "scene/read_scene.hpp"

#include "host/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A COLLADA document with one triangle, up to where its root element begins and from there.
const std::string kProlog = "<?xml version=\"1.0\"?>\n<!-- <COLLADA in a comment> -->\n";
const std::string kRoot =
    "<COLLADA version=\"1.4.1\"><library_geometries><geometry id=\"g\"><mesh><source id=\"s\">"
    "<float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor "
    "source=\"#a\" count=\"3\" stride=\"3\"><param name=\"X\"/><param name=\"Y\"/><param "
    "name=\"Z\"/></accessor></technique_common></source><vertices id=\"v\"><input "
    "semantic=\"POSITION\" source=\"#s\"/></vertices><triangles count=\"1\"><input "
    "semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry>"
    "</library_geometries><library_visual_scenes><visual_scene id=\"S\"><node><instance_geometry "
    "url=\"#g\"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene "
    "url=\"#S\"/></scene></COLLADA>";

class ReadScene : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  ("stromboli_read_scene_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& content) const {
        const std::filesystem::path file = folder_ / name;
        std::ofstream(file, std::ios::binary) << content;
        return file.string();
    }
    size_t trianglesOf(const std::string& name, const std::string& content) const {
        return readScene(write(name, content)).triangles.size();
    }
    static std::string messageOf(const std::string& source) {
        try {
            readScene(source);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "no error";
    }

    std::filesystem::path folder_;
};

/// Both formats are XML, and either may be called so.
TEST_F(ReadScene, XmlIsToldByItsRootElement) {
    EXPECT_EQ(trianglesOf("a.xml", kProlog + kRoot), 1u);
    EXPECT_EQ(trianglesOf("b.xml", "<scene version=\"3.0.0\"><shape type=\"rectangle\"/></scene>"),
              2u);
    SceneConventions defines;
    defines.selection.definitions = {{"spp", "4"}};
    EXPECT_THROW(readScene(write("c.xml", kProlog + kRoot), defines), SceneError);
}

TEST_F(ReadScene, ByTheEndingOfTheName) {
    EXPECT_EQ(trianglesOf("a.dae", kProlog + kRoot), 1u);
    EXPECT_EQ(trianglesOf("a.DAE", kProlog + kRoot), 1u);
    // The loader that the name asks for says what is wrong, and where.
    EXPECT_THAT(messageOf(write("b.dae", "<wrong>\n")),
                AllOf(HasSubstr("b.dae"), HasSubstr("not well-formed XML")));
}

TEST_F(ReadScene, ObjAndPly) {
    const std::string obj = "# by hand\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                            "property float y\nproperty float z\nelement face 1\n"
                            "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n"
                            "1 1 0\n3 0 1 2\n";
    for (const char* ending : {".obj", ".OBJ", "", ".txt"})
        EXPECT_EQ(trianglesOf(std::string("a") + ending, obj), 1u) << ending;
    for (const char* ending : {".ply", ".PLY", "", ".txt"})
        EXPECT_EQ(trianglesOf(std::string("b") + ending, ply), 1u) << ending;
    EXPECT_THAT(messageOf(write("c.ply", obj)), HasSubstr("is no PLY file"));
    EXPECT_THAT(messageOf(write("d.obj", ply)), HasSubstr("has no vertex"));
}

/// What has the height z in a file stands on the ground, and faces the camera with what had the
/// least y.
TEST_F(ReadScene, FilesThatDoNotSayWhatIsUp) {
    SceneConventions conventions;
    conventions.up = UpAxis::Z;
    const Scene scene =
        readScene(write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 3\nf 1 2 3\n"), conventions);
    EXPECT_EQ(scene.bounds().lo, glm::vec3(0, 0, -2));
    EXPECT_EQ(scene.bounds().hi, glm::vec3(1, 3, 0));
    EXPECT_EQ(readScene(write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 3\nf 1 2 3\n")).bounds().hi,
              glm::vec3(1, 2, 3));
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
        "y\nproperty float z\nelement face 1\nproperty list uchar int "
        "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 3\n3 0 1 2\n";
    EXPECT_EQ(readScene(write("a.ply", ply), conventions).bounds().hi, glm::vec3(1, 3, 0));
    for (const std::string& source : {write("a.dae", kProlog + kRoot), std::string("cornell_boxes"),
                                      std::string("generate:cornell_mesh:1000")})
        EXPECT_THROW(readScene(source, conventions), SceneError) << source;
}

TEST_F(ReadScene, ByContentWhereTheNameSaysNothing) {
    for (const char* name : {"scene", "scene.xml", "scene.txt", ".dae"})
        EXPECT_EQ(trianglesOf(name, kProlog + kRoot), 1u) << name;
    EXPECT_EQ(trianglesOf("marked", "\xEF\xBB\xBF" + kProlog + kRoot), 1u);
    EXPECT_EQ(trianglesOf("bare", kRoot), 1u);
    EXPECT_EQ(trianglesOf("typed", "<!DOCTYPE COLLADA>" + kRoot), 1u);
    EXPECT_EQ(trianglesOf("commented", "<!--" + std::string(60000, 'x') + "-->" + kRoot), 1u);
}

TEST_F(ReadScene, OtherFilesAreOneErrorThatNamesTheFormats) {
    for (const char* content :
         {"", "glT", "{\"name\": {}}", "<?xml version=\"1.0\"?><scenery version=\"3.0.0\"/>",
          "<!-- <COLLADA> -->", "<COLLADAS/>", "v 0 0 0\nx 1\n", "<?xml", "COLLADA"}) {
        const std::string file = write("scene.xyz", content);
        EXPECT_THAT(messageOf(file), AllOf(testing::StartsWith(file), HasSubstr("COLLADA (.dae"),
                                           HasSubstr("generate:")))
            << content;
    }
}

TEST_F(ReadScene, FilesThatCannotBeRead) {
    for (const char* name : {"none.dae", "none.xyz", "none"})
        EXPECT_THAT(messageOf((folder_ / name).string()), HasSubstr("there is no such file"))
            << name;
}

TEST_F(ReadScene, OfAFolderItsScenesAreNamed) {
    std::filesystem::create_directories(folder_ / "room" / "maps");
    EXPECT_THAT(messageOf((folder_ / "room").string()),
                testing::EndsWith("is a directory, expected a scene file"));
    for (const char* name : {"room/b.obj", "room/a.GLTF", "room/a.bin", "room/c.xml"})
        write(name, "");
    EXPECT_THAT(messageOf((folder_ / "room").string()),
                testing::EndsWith("expected a scene file; it has a.GLTF, b.obj, c.xml"));
    for (const char* name : {"d.fbx", "e.stl", "f.ply"})
        write(std::string("room/") + name, "");
    EXPECT_THAT(messageOf((folder_ / "room").string()),
                testing::EndsWith("d.fbx, e.stl and 1 others"));
}

TEST_F(ReadScene, SomeFormatsMayBePackedByGzip) {
    const std::string obj = write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    const std::string ply = write(
        "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                 "end_header\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n");
    for (const std::string& file : {obj, ply}) {
        ASSERT_EQ(std::system(("gzip -f " + file).c_str()), 0);
        EXPECT_EQ(readScene(file + ".gz").triangles.size(), 1u) << file;
    }
    EXPECT_THAT(messageOf(write("a.dae.gz", "\x1F\x8B")),
                HasSubstr("is in no format that is read"));
}

TEST_F(ReadScene, BundledScenesByNameFromAnyFolder) {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder_);
    for (const std::string& name : librarySceneNames()) {
        EXPECT_EQ(std::filesystem::path(sceneFile(name)).stem(), name);
        EXPECT_TRUE(std::filesystem::is_regular_file(sceneFile(name))) << name;
    }
    EXPECT_GT(readScene("cornell_boxes").triangles.size(), 12u);
    // A file of that name comes first; a folder does not, which has no scene.
    std::filesystem::create_directory("cornell_spheres");
    EXPECT_EQ(readScene("cornell_spheres").spheres.size(), 3u);
    EXPECT_EQ(trianglesOf("cornell_boxes", kRoot), 1u);
    EXPECT_EQ(readScene("cornell_boxes").triangles.size(), 1u);
    std::filesystem::current_path(before);
}

TEST_F(ReadScene, UnknownNamesAreOneErrorThatNamesTheBundledScenes) {
    EXPECT_EQ(librarySceneNames().size(), 21u);
    for (const char* name : {"nothing_like_it", "../library/cornell_boxes", ""})
        for (const std::string& known : librarySceneNames())
            EXPECT_THAT(messageOf(name), AllOf(HasSubstr("no such file"), HasSubstr(known)))
                << name;
}

TEST_F(ReadScene, NamesAWordLikeTheOneThatIsUnknown) {
    for (const char* name : {"cornell_boxs", "cornell_boxes.dae/"})
        EXPECT_THAT(messageOf(name), HasSubstr("did you mean cornell_boxes?")) << name;
    write("kitchen.gltf", "");
    EXPECT_THAT(messageOf((folder_ / "kitchn.gltf").string()),
                HasSubstr("did you mean " + (folder_ / "kitchen.gltf").string() + "?"));
}

TEST_F(ReadScene, InUtf16) {
    for (const bool marked : {true, false}) {
        std::string text = marked ? std::string("\xFE\xFF") : std::string();
        for (const char c : kProlog + kRoot)
            text += std::string{'\0', c};
        EXPECT_EQ(trianglesOf("utf16.dae", text), 1u);
        EXPECT_EQ(trianglesOf("utf16", text), 1u) << "by its content";
    }
}

TEST_F(ReadScene, GeneratedScenesByTheirPrefix) {
    EXPECT_GT(readScene("generate:lamps:8").triangles.size(), 8u);
    EXPECT_THAT(messageOf("generate:nothing"), HasSubstr("no such scene"));
    EXPECT_THROW(readScene("generate:lamps:8", cs184Conventions()), SceneError);
}

} // namespace
} // namespace stromboli::test

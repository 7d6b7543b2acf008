#include "scene/camera/camera.hpp"
#include "scene/read_scene.hpp"
#include "source_dir.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> libraryFiles() {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(STROMBOLI_SOURCE_DIR "/scene/library"))
        if (entry.path().extension() == ".dae" || entry.path().extension() == ".glb" ||
            entry.path().extension() == ".xml")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

class Library : public testing::TestWithParam<fs::path> {
  protected:
    Scene scene_ = readScene(GetParam().string());
};

INSTANTIATE_TEST_SUITE_P(Files, Library, testing::ValuesIn(libraryFiles()),
                         [](const auto& file) { return file.param.stem().string(); });

TEST(LibraryFolder, HasItsScenes) {
    EXPECT_EQ(libraryFiles().size(), 21u);
}

TEST_P(Library, LoadsWithNothingIgnoredOrDropped) {
    EXPECT_THAT(scene_.report.ignored, testing::IsEmpty());
    EXPECT_THAT(scene_.report.warnings, testing::IsEmpty());
    EXPECT_GT(scene_.triangles.size() + scene_.spheres.size(), 0u);
    EXPECT_EQ(scene_.cameras.size(), 1u);
}

TEST_P(Library, HasSomethingThatShines) {
    const bool emits = std::any_of(scene_.materials.begin(), scene_.materials.end(),
                                   [](const Material& material) { return material.emits(); });
    EXPECT_TRUE(emits || !scene_.lights.empty() || scene_.environment);
}

TEST_P(Library, SaysFirstWhatItShows) {
    std::ifstream file(GetParam(), std::ios::binary);
    std::string line;
    if (GetParam().extension() == ".glb") { // its JSON, the name of the scene
        file.seekg(20);
        std::getline(file, line, '\0');
        EXPECT_THAT(line, testing::ContainsRegex("\"scenes\":.\\{\"name\":\"[^\"]{40}"));
        return;
    }
    std::getline(file, line);
    std::getline(file, line);
    EXPECT_THAT(line, testing::StartsWith("<!-- "));
}

TEST_P(Library, IsListedInTheReadme) {
    std::ifstream file(STROMBOLI_SOURCE_DIR "/scene/library/README.md");
    const std::string readme(std::istreambuf_iterator<char>(file), {});
    EXPECT_THAT(readme, testing::HasSubstr(GetParam().filename().string() + "` |"));
}

/// The dialect's framing (and any other) sees what the file's camera sees, up to the six digits
/// of the numbers in the file.
TEST_P(Library, AutomaticCameraIsTheFilesCamera) {
    const Camera automatic = makeCamera(scene_, CameraChoice::Automatic, 400, 300);
    const Camera file = makeCamera(scene_, CameraChoice::File, 400, 300);
    EXPECT_LT(glm::length(automatic.position - file.position), 2e-6);
    EXPECT_LT(glm::length(automatic.back - file.back), 2e-6);
    EXPECT_LT(glm::length(automatic.up - file.up), 2e-6);
    EXPECT_NEAR(automatic.halfWidth, file.halfWidth, 2e-6);
}

} // namespace
} // namespace stromboli

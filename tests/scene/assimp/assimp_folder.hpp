#pragma once

#include "host/core/error.hpp"
#include "scene/read_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace stromboli {

/// Files in a folder of their own.
class AssimpFiles : public testing::Test {
  protected:
    void SetUp() override {
        folder = std::filesystem::temp_directory_path() /
                 ("stromboli_assimp_" +
                  std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    std::string write(const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
        return (folder / name).string();
    }

    /// The scene, or nothing where Assimp is not there; other errors are the test's.
    std::optional<Scene> read(const std::string& file, const SceneConventions& conventions = {}) {
        try {
            return readScene(file, conventions);
        } catch (const SceneError& error) {
            if (!(std::string(error.what()).find("apt install libassimp") != std::string::npos))
                throw;
            return std::nullopt;
        }
    }

    std::filesystem::path folder;
};

/// Two triangles that share an edge.
inline const char* const kStl = R"(solid two
facet normal 0 0 1
 outer loop
  vertex 0 0 0
  vertex 2 0 0
  vertex 0 3 0
 endloop
endfacet
facet normal 0 0 1
 outer loop
  vertex 2 0 0
  vertex 2 3 0
  vertex 0 3 0
 endloop
endfacet
endsolid two
)";

} // namespace stromboli

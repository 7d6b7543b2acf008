#pragma once

#include "host/core/error.hpp"
#include "host/cs184/cs184.hpp"
#include "scene/collada/load_collada.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace stromboli::test {

/// The parts of a small COLLADA document.
struct DocumentText {
    std::string asset = "<up_axis>Y_UP</up_axis>";
    std::string libraries;
    std::string nodes;

    std::string str() const {
        return fmt::format("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
                           "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
                           "version=\"1.4.1\">\n<asset>{}</asset>\n{}\n"
                           "<library_visual_scenes><visual_scene id=\"Scene\">\n{}\n"
                           "</visual_scene></library_visual_scenes>\n"
                           "<scene><instance_visual_scene url=\"#Scene\"/></scene>\n</COLLADA>\n",
                           asset, libraries, nodes);
    }
};

/// Loads text as if it were a file.
inline Scene loadText(const std::string& text, const SceneConventions& conventions = {}) {
    static int number = 0;
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) /
                                       fmt::format("stromboli_{}_{}.dae", getpid(), ++number);
    struct Removal {
        const std::filesystem::path& file;
        ~Removal() { std::filesystem::remove(file); }
    } removal{file};
    std::ofstream(file, std::ios::binary) << text;
    return loadCollada(file, conventions);
}

/// The message with which a document is refused.
inline std::string errorOf(const std::string& text) {
    try {
        loadText(text);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "no error";
}

inline SceneConventions conventionsOf(bool cs184) {
    return cs184 ? cs184Conventions() : SceneConventions{};
}

inline Scene load(const DocumentText& document, bool cs184 = false) {
    return loadText(document.str(), conventionsOf(cs184));
}

inline std::string floats(const std::string& id, const std::string& numbers, int count) {
    return fmt::format("<source id=\"{0}\"><float_array id=\"{0}-array\" count=\"{2}\">{1}"
                       "</float_array><technique_common><accessor source=\"#{0}-array\" "
                       "count=\"{3}\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
                       "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
                       "</accessor></technique_common></source>",
                       id, numbers, count, count / 3);
}

/// A library with one mesh, "mesh", of these positions; `rest` follows its <vertices id="v">.
inline std::string meshLibrary(const std::string& positions, int count, const std::string& rest,
                               const std::string& sources = "") {
    return fmt::format("<library_geometries><geometry id=\"mesh\" name=\"Mesh\"><mesh>{}{}"
                       "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#pos\"/>"
                       "</vertices>{}</mesh></geometry></library_geometries>",
                       floats("pos", positions, count), sources, rest);
}

inline const char* const kVertexInput = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
inline const char* const kNormalInput = "<input semantic=\"NORMAL\" source=\"#nrm\" offset=\"1\"/>";

/// One triangle (0 0 0) (1 0 0) (0 1 0) without normals.
inline std::string triangleLibrary() {
    return meshLibrary(
        "0 0 0 1 0 0 0 1 0", 9,
        fmt::format("<triangles count=\"1\">{}<p>0 1 2</p></triangles>", kVertexInput));
}

/// A node "N" with these transformations that shows "mesh".
inline std::string meshNode(const std::string& transforms = "") {
    return fmt::format("<node id=\"N\" name=\"N\">{}<instance_geometry url=\"#mesh\"/></node>",
                       transforms);
}

inline void expectNear(const glm::dvec3& actual, const glm::dvec3& expected,
                       double tolerance = 1e-6) {
    EXPECT_LE(glm::distance(actual, expected), tolerance)
        << fmt::format("({}, {}, {}) instead of ({}, {}, {})", actual.x, actual.y, actual.z,
                       expected.x, expected.y, expected.z);
}

/// In the file's coordinates.
inline glm::vec3 corner(const Scene& scene, size_t triangle, int i) {
    return glm::dvec3(scene.positions[scene.triangles.at(triangle).corner[i]]) + scene.origin;
}

inline std::string errorOf(const DocumentText& document) {
    return errorOf(document.str());
}

} // namespace stromboli::test

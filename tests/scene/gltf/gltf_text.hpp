#pragma once

#include "host/core/error.hpp"
#include "scene/gltf/load_gltf.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace stromboli::test {

std::string toBase64(std::string_view bytes);

/// A small glTF file: arrays of the document as JSON, and a buffer that is filled as accessors are
/// added.
class GltfText {
  public:
    /// Elements of the document's arrays, and members of the document that are none.
    std::map<std::string, std::vector<std::string>> arrays;
    std::map<std::string, std::string> members = {{"asset", R"({"version": "2.0"})"}};

    /// Returns the number of a bufferView of these bytes.
    size_t addView(std::string_view bytes, const std::string& more = "");
    /// Returns the number of an accessor of `type` (VEC3, ...).
    template <class T>
    size_t addAccessor(const std::vector<T>& values, const std::string& type,
                       const std::string& more = "") {
        const size_t width = widthOf(type);
        const std::string_view bytes(reinterpret_cast<const char*>(values.data()),
                                     values.size() * sizeof(T));
        return addTo("accessors", fmt::format(R"("bufferView": {}, "componentType": {}, )"
                                              R"("count": {}, "type": "{}"{})",
                                              addView(bytes), componentOf<T>(),
                                              values.size() / width, type, more));
    }
    /// `members` without braces; returns the number of the element.
    size_t addTo(const std::string& array, const std::string& members);
    /// The corners (0 0 0), (1 0 0), (0 1 0), and a node, in the scene, that shows the triangle
    /// with these further members of its primitive and attributes.
    size_t addTriangle(const std::string& primitive = "", const std::string& attributes = "");

    std::string text() const;   ///< with the buffer as a data URI
    std::string binary() const; ///< as .glb

    template <class T>
    static int componentOf() {
        if constexpr (std::is_same_v<T, int8_t>) return 5120;
        if constexpr (std::is_same_v<T, uint8_t>) return 5121;
        if constexpr (std::is_same_v<T, int16_t>) return 5122;
        if constexpr (std::is_same_v<T, uint16_t>) return 5123;
        if constexpr (std::is_same_v<T, uint32_t>) return 5125;
        return 5126;
    }

  private:
    static size_t widthOf(const std::string& type);
    std::string json(const std::string& buffer) const;

    std::string bytes_;
};

/// A folder of its own, removed at the end, for files that belong together.
class Folder {
  public:
    Folder();
    ~Folder();
    std::filesystem::path write(const std::string& name, std::string_view bytes) const;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Loads bytes as if they were a file.
Scene loadGltfBytes(std::string_view bytes, const SceneConventions& conventions = {});
inline Scene load(const GltfText& text, const SceneConventions& conventions = {}) {
    return loadGltfBytes(text.text(), conventions);
}

inline void expectNear(const glm::dvec3& actual, const glm::dvec3& expected,
                       double tolerance = 1e-6) {
    EXPECT_LT(glm::distance(actual, expected), tolerance)
        << actual.x << ' ' << actual.y << ' ' << actual.z;
}

/// What loading complains about, after the file's name; empty if it does not.
std::string gltfProblem(std::string_view bytes, const SceneConventions& conventions = {});
inline std::string problem(const GltfText& text, const SceneConventions& conventions = {}) {
    return gltfProblem(text.text(), conventions);
}

} // namespace stromboli::test

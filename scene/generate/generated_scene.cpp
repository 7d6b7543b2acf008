#include "scene/generate/generated_scene.hpp"

#include "host/core/error.hpp"
#include "scene/generate/cornell_mesh.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace stromboli {
namespace {

constexpr std::string_view kCornellMesh = "cornell_mesh:";
// Fewer triangles make no knot; more leave no room in 32-bit numbers of corners.
constexpr uint32_t kLeastTriangles = 1000, kMostTriangles = 100'000'000;

/// The tube's triangles keep the shape they have in the library's file: ten times as many steps
/// along it as around it.
CornellMesh cornellMeshOf(uint32_t triangles) {
    const double around = std::round(std::sqrt(triangles / 20.0));
    const double along = std::round(triangles / (2 * around));
    return cornellMesh(uint32_t(along), uint32_t(around));
}

} // namespace

Scene generatedScene(std::string_view name) {
    const std::string source = std::string(kGeneratePrefix) + std::string(name);
    uint32_t triangles = 0;
    if (name.starts_with(kCornellMesh)) {
        const std::string_view number = name.substr(kCornellMesh.size());
        const char* const end = number.data() + number.size();
        const auto [last, error] = std::from_chars(number.data(), end, triangles);
        if (error != std::errc() || last != end) triangles = 0;
    }
    if (triangles < kLeastTriangles || triangles > kMostTriangles)
        throw SceneError(fmt::format("{}: no such scene; expected {}{}N with N from {} to {}",
                                     source, kGeneratePrefix, kCornellMesh, kLeastTriangles,
                                     kMostTriangles));
    return cornellMeshScene(cornellMeshOf(triangles), source);
}

Scene readScene(const std::string& source, const LoadOptions& options) {
    if (!source.starts_with(kGeneratePrefix)) return loadCollada(source, options);
    if (options.cs184)
        throw SceneError(source + ": --cs184 is about files; a generated scene has no use for it");
    return generatedScene(std::string_view(source).substr(kGeneratePrefix.size()));
}

} // namespace stromboli

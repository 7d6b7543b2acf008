#include "scene/generate/generated_scene.hpp"

#include "host/core/error.hpp"
#include "host/core/text.hpp"
#include "scene/generate/cornell_mesh.hpp"
#include "scene/generate/emitters_room.hpp"
#include "scene/generate/forest.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace stromboli {
namespace {

// Fewer triangles make no knot; more leave no room in 32-bit numbers of corners.
constexpr uint32_t kLeastTriangles = 1000, kMostTriangles = 100'000'000;
constexpr uint32_t kLeastEmitters = 8, kMostEmitters = 8'000'000;
constexpr uint32_t kMostTrees = 10'000'000;

/// The tube's triangles keep the shape they have in the library's file: ten times as many steps
/// along it as around it.
CornellMesh cornellMeshOf(uint32_t triangles) {
    const double around = std::round(std::sqrt(triangles / 20.0));
    const double along = std::round(triangles / (2 * around));
    return cornellMesh(uint32_t(along), uint32_t(around));
}

/// The number after a prefix; 0 if the name is another one or that is no number.
uint32_t numberAfter(std::string_view prefix, std::string_view name) {
    if (!name.starts_with(prefix)) return 0;
    const uint64_t number = wholeNumber(name.substr(prefix.size())).value_or(0);
    return number <= std::numeric_limits<uint32_t>::max() ? uint32_t(number) : 0;
}

} // namespace

Scene generatedScene(std::string_view name) {
    const std::string source = std::string(kGeneratePrefix) + std::string(name);
    const uint32_t emitters = numberAfter(kEmittersRoom, name);
    if (emitters >= kLeastEmitters && emitters <= kMostEmitters && emitters % 8 == 0)
        return emittersRoom(emitters, source);
    const uint32_t points = numberAfter(kPointsRoom, name);
    if (points > 0 && points <= kMostEmitters) return pointsRoom(points, source);
    const uint32_t trees = numberAfter(kForest, name);
    if (trees > 0 && trees <= kMostTrees) return forest(trees, source);
    const uint32_t triangles = numberAfter(kCornellMesh, name);
    if (triangles < kLeastTriangles || triangles > kMostTriangles)
        throw SceneError(fmt::format("{}: no such scene; expected {}{}N with N from {} to {}, or "
                                     "{}{}N with N from {} to {}, a multiple of 8, or {}{}N with N "
                                     "from 1 to {}, or {}{}N with N from 1 to {}",
                                     source, kGeneratePrefix, kCornellMesh, kLeastTriangles,
                                     kMostTriangles, kGeneratePrefix, kEmittersRoom, kLeastEmitters,
                                     kMostEmitters, kGeneratePrefix, kPointsRoom, kMostEmitters,
                                     kGeneratePrefix, kForest, kMostTrees));
    return cornellMeshScene(cornellMeshOf(triangles), source);
}

} // namespace stromboli

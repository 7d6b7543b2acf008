#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <string>

namespace stromboli {

/// Triangles of one tree of the forest.
inline constexpr uint32_t kTreeTriangles = 10'000;

/// A field of `trees` trees under a plain sky: instances of three kinds of tree, each of
/// kTreeTriangles, turned, tilted and stretched at random, one in nine square metres; seen from
/// above one side. Always the same for the same number.
Scene forest(uint32_t trees, const std::string& source);

} // namespace stromboli

#pragma once

#include "scene/collada/document.hpp"
#include "scene/collada/numbers.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::collada {

/// The vectors of 2 or 3 components a <source> holds, read through its accessor (offset, stride,
/// count; unnamed <param>s are skipped, as the standard asks, and so is what comes after the last
/// component). Throws SceneError if the array's count is not its length or the accessor reaches
/// past it.
template <int size>
std::vector<glm::vec<size, double>> readVectors(const Document& document, const Element& source,
                                                NonFinite nonFinite);

} // namespace stromboli::collada

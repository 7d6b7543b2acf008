#pragma once

#include "scene/collada/document.hpp"
#include "scene/collada/numbers.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::collada {

/// The three-component vectors a <source> holds, read through its accessor (offset, stride, count;
/// unnamed <param>s are skipped, as the standard asks). Throws SceneError if the array's count is
/// not its length or the accessor reaches past it.
std::vector<glm::dvec3> readVectors(const Document& document, const Element& source,
                                    NonFinite nonFinite);

} // namespace stromboli::collada

#pragma once

#include "scene/collada/document.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::collada {

/// From the file's axes and unit to the world's: y up, metres (`up_axis`, `unit`). `useUnit` false
/// leaves lengths as they are.
glm::dmat4 fileToWorld(const Document& document, bool useUnit);

/// Metres per unit of length of the file; 1, which is said, where that is not positive and finite.
double metersPerUnit(const Document& document);

/// The product of the node's transformation elements, in document order: the first in the file is
/// the last applied to a point. One that makes no sense has no effect, which is said.
glm::dmat4 nodeTransform(const Document& document, const Element& node);

/// The matrix of the first sixteen numbers, which are in rows as in files.
glm::dmat4 matrixOfRows(const std::vector<double>& numbers);

/// True for <matrix>, <translate>, <rotate>, <scale>, <lookat> and <skew>.
bool isTransform(const Element& element);

} // namespace stromboli::collada

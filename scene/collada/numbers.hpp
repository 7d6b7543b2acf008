#pragma once

#include "scene/collada/document.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace stromboli::collada {

enum class NonFinite { Reject, Allow };

/// All numbers in the element's text, separated by white space. Throws SceneError for anything
/// that is not a number and, unless allowed, for NaN and infinities (overflow is one; numbers too
/// small for a double read as 0).
std::vector<double> readNumbers(const Document& document, const Element& at,
                                NonFinite nonFinite = NonFinite::Reject);

/// Reads exactly `count` numbers, or fails.
std::vector<double> readNumbers(const Document& document, const Element& at, size_t count);

/// One number.
double readNumber(const Document& document, const Element& at);

/// The element's child `name` as a number, or `otherwise` where there is no such child.
double readNumberOr(const Document& document, const Element& parent, const char* name,
                    double otherwise);

/// Three numbers, or more of which the first three count (an alpha value), as a colour. Throws
/// SceneError if one does not fit in a float.
glm::vec3 readColor(const Document& document, const Element& at);

/// A number that must fit in a float.
float toFloat(const Document& document, const Element& at, double number);

/// All numbers in the element's text: non-negative integers below 2^32.
std::vector<uint32_t> readIndices(const Document& document, const Element& at);

/// The attribute as a non-negative integer below 2^32; throws SceneError if it is anything else
/// or missing.
uint32_t readCount(const Document& document, const Element& at, const char* attribute);

/// Reads likewise, with a value for a missing attribute.
uint32_t readCountOr(const Document& document, const Element& at, const char* attribute,
                     uint32_t otherwise);

/// The attribute as a finite number; throws SceneError if it is anything else.
double readAttributeOr(const Document& document, const Element& at, const char* attribute,
                       double otherwise);

} // namespace stromboli::collada

#pragma once

#include "scene/build/file_place.hpp"

#include <glm/glm.hpp>

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli::mitsuba {

/// An attribute of the element by its name; nothing if it has none.
using Attributes = std::function<std::optional<std::string>(std::string_view)>;

/// x, y and z by their attributes, or all three by `value`; those that are not stated are
/// `otherwise`.
glm::dvec3 vectorOfAttributes(const build::FilePlace& where, const Attributes& attributes,
                              double otherwise);

/// One step of a <transform>: translate, rotate, scale, lookat or matrix. It comes after the steps
/// before it: the transform is the product of their matrices, the last one leftmost.
glm::dmat4 transformStep(const build::FilePlace& where, std::string_view tag,
                         const Attributes& attributes);

} // namespace stromboli::mitsuba

#pragma once

#include <glm/glm.hpp>

namespace stromboli::build {

/// Twice the signed area of the triangle a b c, with the exact sign: positive if it runs
/// counter-clockwise. Exact as long as no product of two coordinates overflows or underflows.
double orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

} // namespace stromboli::build

#pragma once

#include "host/reference/sampling.hpp"

#include <glm/glm.hpp>

#include <cmath>

/// What the samplers of host/reference made their directions from: their distribution functions. A
/// sampler follows its density if, and only if, its inverse makes uniform numbers of its samples.
namespace stromboli::test {

/// The number that leads to the angle about z, in [0, 1).
inline double turn(const glm::dvec3& w) {
    const double turns = std::atan2(w.y, w.x) / (2 * reference::kPi);
    return turns < 0 ? turns + 1 : turns;
}

inline glm::dvec2 invertCosineHemisphere(const glm::dvec3& w) {
    return {w.x * w.x + w.y * w.y, turn(w)};
}

/// The inverse of uniformCone; the hemisphere's cone is 1, the sphere's 2.
inline glm::dvec2 invertUniformCone(const glm::dvec3& w, double oneMinusCosMax) {
    // Without cancellation, where there would be any.
    const double sine2 = w.x * w.x + w.y * w.y;
    const double oneMinusCos = w.z > 0 ? sine2 / (1 + w.z) : 1 - w.z;
    return {oneMinusCos / oneMinusCosMax, turn(w)};
}

inline glm::dvec2 invertBeckmann(const glm::dvec3& h, double alpha) {
    const double tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
    return {-std::expm1(-tan2 / (alpha * alpha)), turn(h)};
}

/// b: weights of the second and third corner. To the square, but not the inverse: the sampler folds
/// it.
inline glm::dvec2 squareOfTriangle(const glm::dvec2& b) {
    const double rest = b.x + b.y;
    return {rest * rest, rest > 0 ? b.y / rest : 0};
}

} // namespace stromboli::test

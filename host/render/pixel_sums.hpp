#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace stromboli {

/// The statistics of a pixel to the last bit, as the backend that took its samples keeps them: what
/// it needs to go on as if it had never stopped. Only a backend of the same kind understands them.
struct PixelSums {
    uint32_t count = 0, rejected = 0, firstRejected = 0xFFFFFFFFu;
    /// The kernel: the sum of the samples and what rounding took from it. The reference: the mean.
    glm::dvec3 first{0.0}, firstError{0.0};
    /// The kernel: the sum of squared deviations, and what rounding took from it. The reference:
    /// the former.
    glm::dvec3 second{0.0}, secondError{0.0};
};

} // namespace stromboli

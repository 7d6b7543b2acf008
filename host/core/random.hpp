#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <random>

namespace stromboli {

/// Random numbers that are the same on every machine: the engine is standardised, the library's
/// distributions are not.
class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}

    float uniform() { return float(uint32_t(engine_()) >> 8) * 0x1p-24f; } ///< in [0, 1)
    float uniform(float a, float b) { return a + (b - a) * uniform(); }
    uint32_t below(uint32_t n) { return uint32_t(engine_()) % n; }
    uint32_t word() { return uint32_t(engine_()); }
    glm::vec3 inCube(float half) {
        const float x = uniform(-half, half), y = uniform(-half, half);
        return {x, y, uniform(-half, half)};
    }
    /// A vector of a length between 0.1 and sqrt(3), as directions of rays may have; not uniform.
    glm::vec3 vector() {
        for (;;) {
            const glm::vec3 v = inCube(1);
            if (glm::dot(v, v) > 0.01f) return v;
        }
    }
    /// A unit vector, uniform over the sphere.
    glm::vec3 direction() {
        for (;;) {
            const glm::vec3 d = inCube(1);
            const float square = glm::dot(d, d);
            if (square > 0.01f && square < 1) return d / std::sqrt(square);
        }
    }
    /// A float with a uniform logarithm in [least, most].
    float ofAnySize(float least, float most) {
        return std::exp(uniform(std::log(least), std::log(most)));
    }

  private:
    std::mt19937 engine_;
};

} // namespace stromboli

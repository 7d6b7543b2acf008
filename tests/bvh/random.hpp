#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <random>

namespace stromboli::test {

/// Random numbers that are the same everywhere: the engine is standardised, distributions are not.
class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}

    float uniform() { return float(uint32_t(engine_()) >> 8) * 0x1p-24f; } ///< in [0, 1)
    float uniform(float a, float b) { return a + (b - a) * uniform(); }
    uint32_t below(uint32_t n) { return uint32_t(engine_()) % n; }
    glm::vec3 inCube(float half) {
        const float x = uniform(-half, half), y = uniform(-half, half);
        return {x, y, uniform(-half, half)};
    }
    /// A direction, not uniform, of a length that is not 1.
    glm::vec3 direction() {
        for (;;) {
            const glm::vec3 d = inCube(1);
            if (glm::dot(d, d) > 0.01f) return d;
        }
    }

  private:
    std::mt19937 engine_;
};

} // namespace stromboli::test

#pragma once

#include "host/reference/sampling.hpp"

#include <random>

namespace stromboli::test {

class Uniform {
  public:
    explicit Uniform(uint64_t seed) : engine_(seed) {}
    double operator()() { return double(engine_() >> 11) * 0x1p-53; }
    glm::dvec3 direction() { return reference::uniformSphere((*this)(), (*this)()); }

  private:
    std::mt19937_64 engine_;
};

} // namespace stromboli::test

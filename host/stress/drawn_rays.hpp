#pragma once

#include "host/core/random.hpp"
#include "host/stress/case.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace stromboli::stress {

/// So many rays, the same on any number of threads. draw(random, i) makes the one of this number.
std::vector<Ray> drawnRays(uint64_t count, uint32_t seed,
                           const std::function<Ray(Random&, uint64_t)>& draw);

/// A ray from there to there and beyond, its direction a unit vector every other time.
Ray rayTowards(const glm::vec3& origin, const glm::vec3& target, uint64_t number);

/// Traces so many rays, in batches that ask in turn for any hit and for the nearest, and adds to
/// the finding how many hit nothing. draw(n) makes n of them; where: said of them if one missed.
void countMisses(Run& run, RayTracer& tracer, uint64_t rays,
                 const std::function<std::vector<Ray>(uint64_t)>& draw, const std::string& where,
                 Finding& f);

} // namespace stromboli::stress

#include "host/stress/drawn_rays.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace stromboli::stress {
namespace {

constexpr uint64_t kBatch = 1u << 20; ///< rays traced at once
constexpr uint64_t kRun = 1u << 12;   ///< rays drawn with one seed

} // namespace

std::vector<Ray> drawnRays(uint64_t count, uint32_t seed,
                           const std::function<Ray(Random&, uint64_t)>& draw) {
    std::vector<Ray> rays(count);
    tbb::parallel_for(uint64_t(0), (count + kRun - 1) / kRun, [&](uint64_t run) {
        Random random(seed + uint32_t(run));
        for (uint64_t i = run * kRun; i < std::min(count, (run + 1) * kRun); ++i)
            rays[i] = draw(random, i);
    });
    return rays;
}

Ray rayTowards(const glm::vec3& origin, const glm::vec3& target, uint64_t number) {
    glm::vec3 direction = target - origin;
    if (number & 1) direction = glm::normalize(direction);
    return {origin, kMissed, direction, 0};
}

void countMisses(Run& run, RayTracer& tracer, uint64_t rays,
                 const std::function<std::vector<Ray>(uint64_t)>& draw, const std::string& where,
                 Finding& f) {
    for (uint64_t done = 0; done < rays; done += kBatch) {
        const uint64_t count = std::min(kBatch, rays - done);
        const uint64_t missed = count - tracer.countHits(draw(count), done / kBatch % 2 == 0);
        if (missed > 0) f.where = where;
        f.measured += double(missed);
        f.trials += count;
        run.goOn();
    }
}

} // namespace stromboli::stress

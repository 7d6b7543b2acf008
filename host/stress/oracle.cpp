#include "host/stress/oracle.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::stress {

// --- The oracle ----------------------------------------------------------------------------------

namespace {

/// The distance of what is not hit for certain.
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Gathers what may and what must be hit.
class Verdict {
  public:
    Verdict(const Ray& ray, float found, double error)
        : length_(glm::length(glm::dvec3(ray.direction))), tMax_(ray.tMax), found_(found),
          error_(error) {}

    void add(const Crossing& c) {
        if (!(c.margin > -error_)) return;
        // The hit's place moves along the ray by the error across it, over the cosine.
        const double slack = 4 * error_ / std::max(c.cosine, 1e-6) / length_;
        explained_ |= std::abs(c.t - found_) <= slack;
        if (c.margin > error_ && c.t > slack && c.t < tMax_ - slack)
            latest_ = std::min(latest_, c.t + slack);
    }
    bool right() const {
        return found_ == kMissed ? latest_ == kNever : explained_ && found_ <= latest_;
    }

  private:
    double length_, tMax_, found_, error_;
    bool explained_ = false;
    double latest_ = kNever; ///< by then something has been hit for certain
};

void addSphere(const Sphere& s, const Ray& ray, Verdict& verdict) {
    const glm::dvec3 d(ray.direction), f = glm::dvec3(ray.origin) - glm::dvec3(s.center);
    const double length = glm::length(d), closest = -glm::dot(f, d) / (length * length);
    const double across = glm::length(glm::cross(f, d)) / length, r = s.radius;
    const double half = std::sqrt(std::max((r - across) * (r + across), 0.0));
    for (const double side : {-half, half})
        verdict.add({closest + side / length, r - across, half / r});
}

} // namespace

Crossing crossTriangle(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2,
                       const Ray& ray) {
    const glm::dvec3 o(ray.origin), d(ray.direction), axis = glm::normalize(d);
    const glm::dvec3 corner[3] = {v0 - o, v1 - o, v2 - o};
    const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double slope = glm::dot(normal, axis), area = glm::length(normal);
    if (slope == 0) return {};
    Crossing c;
    c.t = glm::dot(normal, corner[0]) / glm::dot(normal, d);
    c.cosine = std::abs(slope) / area;
    c.margin = kNever;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 a = corner[i], b = corner[(i + 1) % 3];
        const double side = glm::dot(glm::cross(a, b), axis) * (slope > 0 ? 1 : -1);
        c.margin = std::min(c.margin, side / glm::length(glm::cross(b - a, axis)));
    }
    return c;
}

bool isClosestHit(const Scene& scene, const Ray& ray, float found, double error) {
    Verdict verdict(ray, found, error);
    for (const Triangle& t : scene.triangles)
        verdict.add(crossTriangle(scene.positions[t.corner[0]], scene.positions[t.corner[1]],
                                  scene.positions[t.corner[2]], ray));
    for (const Sphere& s : scene.spheres)
        addSphere(s, ray, verdict);
    return verdict.right();
}

// --- Rays drawn at random ------------------------------------------------------------------------

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

#include "tests/hard_cases/cpu_subject.hpp"

#include "host/bvh/cpu_traversal.hpp"
#include "host/reference/reference_backend.hpp"

namespace stromboli::test {
namespace {

class CpuTracer final : public stress::RayTracer {
  public:
    explicit CpuTracer(const Scene& scene) : layout_(buildWideBvh(scene)) {}

    uint64_t countHits(std::span<const stress::Ray> rays, bool any) override {
        uint64_t hits = 0;
        for (const stress::Ray& r : rays)
            hits +=
                any ? anyHit(layout_, asTraversed(r)) : bool(closestHit(layout_, asTraversed(r)));
        return hits;
    }
    std::vector<float> distances(std::span<const stress::Ray> rays) override {
        std::vector<float> found;
        for (const stress::Ray& r : rays) {
            const TraversalHit hit = closestHit(layout_, asTraversed(r));
            found.push_back(hit ? hit.t : stress::kMissed);
        }
        return found;
    }

  private:
    static TraversalRay asTraversed(const stress::Ray& r) {
        TraversalRay ray;
        ray.origin = r.origin, ray.direction = r.direction, ray.tMax = r.tMax;
        return ray;
    }
    WideLayout layout_;
};

} // namespace

std::unique_ptr<stress::RayTracer> CpuSubject::tracer(const Scene& scene) {
    return std::make_unique<CpuTracer>(scene);
}

stress::Picture CpuSubject::render(const Scene& scene, const Camera& camera,
                                   const RenderSettings& settings, const KernelTuning&,
                                   const ProgressCallback& progress) {
    ReferenceBackend backend(scene, camera, settings);
    stress::Picture picture;
    picture.film = stromboli::render(backend, settings, progress);
    picture.rays = backend.counters().rays;
    return picture;
}

std::vector<stress::FloatFacts> CpuSubject::floatFacts(std::span<const stress::FloatPair> pairs) {
    std::vector<stress::FloatFacts> facts;
    for (const auto& [a, b] : pairs)
        facts.push_back({{a + b, a - b, a * b, -a},
                         uint32_t(a < b) | uint32_t(a <= b) << 1 | uint32_t(a > b) << 2 |
                             uint32_t(a >= b) << 3 | uint32_t(a == b) << 4 | uint32_t(a != b) << 5 |
                             uint32_t(!(a < b)) << 6});
    return facts;
}

} // namespace stromboli::test

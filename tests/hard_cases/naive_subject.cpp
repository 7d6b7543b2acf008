#include "tests/hard_cases/naive_subject.hpp"

#include "scene/model/placements.hpp"
#include "tests/hard_cases/naive_intersection.hpp"

#include <bit>
#include <cmath>

namespace stromboli::test {
namespace naive {
namespace {

/// To the nearest number of 11 bits, as in half precision but for its range.
float roundedToHalf(float x) {
    return std::bit_cast<float>((std::bit_cast<uint32_t>(x) + 0x1000u) & ~0x1FFFu);
}

glm::vec3 roundedToHalf(const glm::vec3& v) {
    return {roundedToHalf(v.x), roundedToHalf(v.y), roundedToHalf(v.z)};
}

bool entersBoxOf(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                 const glm::vec3& origin, const glm::vec3& direction, float tMax) {
    return entersBox(roundedToHalf(glm::min(a, glm::min(b, c))),
                     roundedToHalf(glm::max(a, glm::max(b, c))), origin, direction, tMax, true);
}

glm::vec3 shadingNormal(const Scene& scene, const Triangle& t) {
    return t.normals[0] == kNoNormals ? scene.geometricNormal(t) : scene.normals[t.normals[0]];
}

} // namespace

Hit closest(const Scene& scene, const glm::vec3& origin, const glm::vec3& direction, float tMin,
            float tMax) {
    Hit hit;
    hit.t = tMax;
    const Triangle* triangle = nullptr;
    for (const Triangle& t : scene.triangles) {
        const glm::vec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]];
        const glm::vec3 c = scene.positions[t.corner[2]];
        if (!entersBoxOf(a, b, c, origin, direction, hit.t)) continue;
        const float found = hitTriangle(a, b, c, origin, direction);
        if (found <= tMin || found >= hit.t) continue; // NaN is taken for a hit
        hit.t = found;
        hit.material = &scene.materials[t.material];
        triangle = &t;
    }
    if (triangle) {
        hit.geometric = scene.geometricNormal(*triangle);
        hit.shading = shadingNormal(scene, *triangle);
        hit.triangle = triangle;
    }
    for (const Sphere& s : scene.spheres) {
        const float found = hitSphere(s.center, s.radius, origin, direction, tMin);
        if (!(found < hit.t)) continue;
        hit.t = found;
        hit.material = &scene.materials[s.material];
        hit.triangle = nullptr;
        hit.geometric = hit.shading = (origin + found * direction - s.center) / s.radius;
    }
    if (!hit) hit.t = stress::kMissed;
    return hit;
}

} // namespace naive

namespace {

class NaiveTracer final : public stress::RayTracer {
  public:
    explicit NaiveTracer(const Scene& scene) : scene_(scene) {}

    uint64_t countHits(std::span<const stress::Ray> rays, bool) override {
        uint64_t hits = 0;
        for (const stress::Ray& r : rays)
            hits += distance(r) != stress::kMissed;
        return hits;
    }
    std::vector<float> distances(std::span<const stress::Ray> rays) override {
        std::vector<float> found;
        for (const stress::Ray& r : rays)
            found.push_back(distance(r));
        return found;
    }

  private:
    /// Placements are met in the space of their mesh, with rays that are rounded there.
    float distance(const stress::Ray& r) const {
        if (scene_.placements.empty())
            return naive::closest(scene_, r.origin, r.direction, 0, r.tMax).t;
        float t = r.tMax;
        for (const Placement& p : scene_.placements) {
            const PlacementMatrices m = matricesOf(p);
            const glm::mat3 inverse(m.inverseLinear);
            t = naive::closest(scene_, inverse * r.origin + glm::vec3(m.inverseOffset),
                               inverse * r.direction, 0, t)
                    .t;
        }
        return t;
    }

    Scene scene_;
};

/// Sums in float, whatever the samples are.
struct NaivePixel {
    glm::vec3 sum{0.0f}, squares{0.0f};
    uint32_t count = 0;

    void add(const glm::vec3& x) { sum += x, squares += x * x, ++count; }
    PixelStatistics statistics() const {
        PixelStatistics p;
        p.count = count;
        if (count == 0) return p;
        p.mean = glm::dvec3(sum / float(count));
        p.m2 = glm::dvec3(squares - sum * sum / float(count));
        return p;
    }
};

} // namespace

/// Positions become floats before they are taken relative to the scene.
std::unique_ptr<stress::RayTracer> NaiveSubject::tracer(const Scene& scene) {
    Scene rounded = scene;
    for (glm::vec3& p : rounded.positions)
        p = glm::vec3(glm::dvec3(glm::vec3(glm::dvec3(p) + scene.origin)) - scene.origin);
    return std::make_unique<NaiveTracer>(rounded);
}

stress::Picture NaiveSubject::render(const Scene& original, const Camera& camera,
                                     const RenderSettings& s, const KernelTuning& tuning,
                                     const ProgressCallback&) {
    const Scene scene = expandPlacements(original).scene;
    stress::Picture picture;
    picture.film = Film(s.area.width, s.area.height);
    const uint32_t group = tuning.workgroupSize.value_or(64);
    for (uint32_t y = 0; y < s.area.height / 8 * 8; ++y)
        for (uint32_t x = 0; x < s.area.width / 8 * 8; ++x) {
            const uint32_t index = y * s.area.width + x;
            naive::Random random(index / group * 977 + index % group + s.estimator.seed);
            NaivePixel pixel;
            for (uint32_t i = 0; i < s.budget.mostSamplesPerPixel; ++i) {
                const float u = 2 * (float(x) + random.uniform()) / float(s.area.width) - 1;
                const float v = 1 - 2 * (float(y) + random.uniform()) / float(s.area.height);
                const glm::vec3 offset = u * glm::vec3(camera.halfWidth * camera.right) +
                                         v * glm::vec3(camera.halfHeight * camera.up);
                const glm::vec3 position(camera.position), back(camera.back);
                const glm::vec3 origin = camera.orthographic ? position + offset : position;
                const glm::vec3 direction =
                    glm::normalize(camera.orthographic ? -back : offset - back);
                pixel.add(naive::radiance(scene, s, origin, direction, float(camera.nearDistance),
                                          random, picture.rays));
            }
            picture.film.at(x, y) = pixel.statistics();
        }
    return picture;
}

std::vector<stress::RandomBlock>
NaiveSubject::randomBlocks(std::span<const stress::Words> counters) {
    std::vector<stress::RandomBlock> blocks;
    for (const stress::Words& c : counters) {
        // Seeds in sequence, and the word itself for a number.
        uint32_t state = c[0] + c[1] * 800 + c[2] + c[3];
        stress::RandomBlock& b = blocks.emplace_back();
        for (size_t k = 0; k < 4; ++k) {
            state = state * 1664525u + 1013904223u;
            b.words[k] = state;
            b.numbers[k] = float(state) * 0x1p-32f;
        }
    }
    return blocks;
}

/// Towards zero.
static float cutOff(double x) {
    const auto nearest = float(x);
    return std::abs(double(nearest)) > std::abs(x) ? std::nextafterf(nearest, 0.0f) : nearest;
}

std::vector<stress::FloatFacts> NaiveSubject::floatFacts(std::span<const stress::FloatPair> pairs) {
    std::vector<stress::FloatFacts> facts;
    for (const auto& [x, y] : pairs) {
        const double a = x, b = y;
        const bool isAbove = a > b, isBelow = a < b;
        facts.push_back({{cutOff(a + b), cutOff(a - b), cutOff(a * b), 0.0f - x},
                         uint32_t(isBelow) | uint32_t(!isAbove) << 1 | uint32_t(isAbove) << 2 |
                             uint32_t(!isBelow) << 3 | uint32_t(!isAbove && !isBelow) << 4 |
                             uint32_t(isAbove || isBelow) << 5 | uint32_t(!isBelow) << 6});
    }
    return facts;
}

} // namespace stromboli::test

// Primitives that are hard to hit, and rays that are hard to follow.
#include "host/stress/case.hpp"
#include "host/stress/oracle.hpp"
#include "scene/generate/hard_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::stress {
namespace {

constexpr double kUlp = 0x1p-23;

/// A right-angled triangle with legs `size`, turned at random, near the origin.
Scene oneTriangle(float size, Random& random) {
    const glm::vec3 e = random.direction();
    const glm::vec3 f = glm::normalize(glm::cross(e, random.direction()));
    const glm::vec3 corner = size * random.inCube(1);
    Scene scene;
    scene.positions = {corner, corner + size * e, corner + size * f};
    scene.triangles.resize(1);
    scene.triangles[0].corner[1] = 1, scene.triangles[0].corner[2] = 2;
    scene.materials.resize(1);
    scene.instances = {"triangle"};
    return scene;
}

/// Rays at points well inside, from one to two legs off, at less than 60 degrees to the normal.
std::vector<Ray> raysInto(const Scene& scene, float size, size_t count, Random& random) {
    const glm::vec3 *v = scene.positions.data(), e = v[1] - v[0], f = v[2] - v[0];
    const glm::vec3 normal = glm::normalize(glm::cross(e / size, f / size));
    std::vector<Ray> rays;
    while (rays.size() < count) {
        const float b1 = random.uniform(0.1f, 0.8f), b2 = random.uniform(0.1f, 0.9f - b1);
        const glm::vec3 away = random.direction();
        if (std::abs(glm::dot(away, normal)) < 0.5f) continue;
        const glm::vec3 origin = v[0] + b1 * e + b2 * f + size * random.uniform(1, 2) * away;
        rays.push_back({origin, kMissed, -random.uniform(0.5f, 2) * away, 0});
    }
    return rays;
}

/// Largest error of t over triangles of one size; a lost one has no right digit.
Finding distancesOn(Run& run, const std::vector<float>& sizes, uint32_t seed) {
    Finding f;
    f.bound = 4;
    Random random(seed);
    const int triangles = run.amount(2, 24);
    for (const float size : sizes)
        for (int i = 0; i < triangles; ++i) {
            const Scene scene = oneTriangle(size, random);
            const auto rays = raysInto(scene, size, run.amount<size_t>(1000, 20000), random);
            const auto found = run.subject().tracer(scene)->distances(rays);
            for (size_t k = 0; k < rays.size(); ++k) {
                const double expected = crossTriangle(scene.positions[0], scene.positions[1],
                                                      scene.positions[2], rays[k])
                                            .t;
                const double error = std::min(std::abs(found[k] - expected) / expected, 1.0) / kUlp;
                if (!(error <= f.measured))
                    f.measured = error, f.where = fmt::format("legs of {}", size);
            }
            f.trials += rays.size();
            run.goOn();
        }
    return f;
}

Finding tiny(Run& run) {
    return distancesOn(run, {2e-4f, 1e-6f, 1e-12f}, 1011);
}

Finding huge(Run& run) {
    return distancesOn(run, {1e6f, 1e9f, 1e13f}, 1012);
}

/// Every other ray starts on the planes of a grid that many boxes end on, and runs within them.
Ray rayThroughSoup(Random& random) {
    Ray ray{random.inCube(random.below(2) ? 1.0f : 4.0f), kMissed, {}, 0};
    ray.direction = random.below(2) ? random.direction() : random.inCube(1) - ray.origin;
    const uint32_t kind = random.below(8);
    if (kind < 4) ray.direction[int(kind % 3)] = random.below(2) ? 0.0f : -0.0f;
    if (kind < 2) ray.direction[int(kind + 1)] = random.below(2) ? 0.0f : -0.0f;
    if (kind < 4)
        for (int k = 0; k < 3; ++k)
            ray.origin[k] = std::round(4 * ray.origin[k]) / 4;
    return ray;
}

Finding soups(Run& run) {
    Finding f;
    Random random(1013);
    // Coordinates stay below 8 and carry some 20 roundings.
    constexpr double kError = 8 * 20 * 0x1p-24;
    const std::vector<uint32_t> counts = {1, 2, 3, 4, 5, 8, 9, 15, 100, 500, 2000};
    for (const uint32_t n : counts)
        for (const uint32_t spheres : {0u, n / 2}) {
            Scene scene = soup(n - spheres, spheres, 1 / std::cbrt(float(n)), random);
            if (n % 2) // boxes that end in planes where rays start
                for (glm::vec3& p : scene.positions)
                    p = glm::round(4.0f * p) / 4.0f;
            std::vector<Ray> rays;
            for (size_t i = 0; i < run.amount<size_t>(500, 10000); ++i)
                rays.push_back(rayThroughSoup(random));
            const auto found = run.subject().tracer(scene)->distances(rays);
            for (size_t i = 0; i < rays.size(); ++i)
                if (!isClosestHit(scene, rays[i], found[i], kError))
                    ++f.measured, f.where = fmt::format("{} primitives", n);
            f.trials += rays.size();
            run.goOn();
        }
    return f;
}

/// Rays from 1e7 away that, in double precision, pass through a triangle well inside its edges.
/// Along the axis the origin's distance to a corner is rounded to a whole unit, which only blurs t;
/// across it, float errors stay below 8 * 2^-24 of a unit or two.
Finding farOrigin(Run& run) {
    constexpr double kMargin = 2e-6;
    constexpr uint32_t kTriangles = 2000;
    Random random(1014);
    const Scene scene = soup(kTriangles, 0, 0.05f, random);
    const auto tracer = run.subject().tracer(scene);
    Finding f;
    for (size_t batch = 0; batch < run.amount<size_t>(1, 50); ++batch) {
        std::vector<Ray> rays;
        while (rays.size() < 100'000) {
            const uint32_t* corner = scene.triangles[random.below(kTriangles)].corner;
            const glm::vec3 a = scene.positions[corner[0]], b = scene.positions[corner[1]];
            const glm::vec3 c = scene.positions[corner[2]];
            const float u = random.uniform(), v = random.uniform() * (1 - u);
            Ray ray{random.inCube(1), kMissed, {}, 0};
            ray.origin[int(random.below(3))] = random.below(2) ? 1e7f : -1e7f;
            ray.direction = a + u * (b - a) + v * (c - a) - ray.origin;
            if (random.below(2)) ray.direction *= 1e-7f;
            if (crossTriangle(a, b, c, ray).margin > kMargin) rays.push_back(ray);
        }
        f.measured += double(rays.size() - tracer->countHits(rays, batch % 2 == 0));
        f.trials += rays.size();
        run.goOn();
    }
    return f;
}

/// Any part of a ray that is not finite makes it miss, and it ends: a subject whose rays do not end
/// throws.
Finding notFinite(Run& run) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    Random random(1015);
    const Scene scene = soup(500, 100, 0.3f, random);
    std::vector<Ray> rays;
    for (size_t k = 0; k < run.amount<size_t>(100, 10000); ++k) {
        for (const float bad : {kNaN, -kNaN, kInfinity, -kInfinity})
            for (int i = 0; i < 6; ++i) {
                Ray ray{random.inCube(1), kMissed, random.direction(), 0};
                (i < 3 ? ray.origin : ray.direction)[i % 3] = bad;
                rays.push_back(ray);
            }
        rays.push_back({random.inCube(1), kNaN, random.direction(), 0});
        rays.push_back({random.inCube(1), kMissed, glm::vec3(k % 2 ? 0.0f : -0.0f), 0});
    }
    const auto tracer = run.subject().tracer(scene);
    Finding f;
    f.trials = 2 * rays.size();
    f.measured = double(tracer->countHits(rays, true));
    for (const float t : tracer->distances(rays))
        f.measured += t != kMissed;
    return f;
}

/// Rays at a square of 4 radii about a sphere of radius 0.1, from `distance` away. As shadow rays:
/// the direction is the difference of two points. Far along an axis the coordinates across it stay
/// exact; elsewhere the points are on a grid of 2^-23 of the distance, whatever the test does.
std::vector<Ray> raysAtSphere(const Sphere& s, float distance, size_t count, Random& random) {
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        glm::vec3 axis(0.0f), side(0.0f);
        axis[int(i % 3)] = i & 1 ? 1.0f : -1.0f;
        side[int((i + 1) % 3)] = 1;
        const glm::vec3 target = s.center + s.radius * random.uniform(-2, 2) * side +
                                 s.radius * random.uniform(-2, 2) * glm::cross(axis, side);
        const glm::vec3 origin = s.center + s.radius * random.inCube(1) - distance * axis;
        rays.push_back({origin, kMissed, target - origin, 0});
    }
    return rays;
}

Finding farSpheres(Run& run) {
    Finding f;
    f.bound = 3;
    Random random(1016);
    Scene scene = soup(0, 1, 0.1f, random);
    Sphere& s = scene.spheres[0];
    s.radius = 0.1f;
    s.center *= 0.1f;
    const size_t count = run.amount<size_t>(100'000, 2'000'000);
    const double share = M_PI / 16, sigma = std::sqrt(double(count) * share * (1 - share));
    for (const float distance : {1e2f, 1e3f, 1e4f, 1e5f, 1e6f}) {
        const auto rays = raysAtSphere(s, distance, count, random);
        const auto hits = double(run.subject().tracer(scene)->countHits(rays, false));
        const double z = std::abs(hits - double(count) * share) / sigma;
        if (z > f.measured) f.measured = z, f.where = fmt::format("from {}", distance);
        f.trials += count;
        run.goOn();
    }
    return f;
}

} // namespace

std::vector<Case> intersectionCases() {
    return {
        {"tiny-triangles", "6", "legs of 2e-4 to 1e-12: hit, and where", "ulp of t", "rays", tiny},
        {"huge-triangles", "7", "legs of 1e6 to 1e13: hit, and where", "ulp of t", "rays", huge},
        {"soups", "17, 22", "the closest hit, as trying all primitives in double finds it", "wrong",
         "rays", soups},
        {"far-origin", "24", "triangles in a unit cube are hit from 1e7 away", "missed", "rays",
         farOrigin},
        {"not-finite", "27", "rays with NaN or infinite parts hit nothing, and end", "hits", "rays",
         notFinite},
        {"far-spheres", "29", "radius 0.1 from 1e2 to 1e6 away: the share of rays that hit",
         "sigma", "rays", farSpheres},
    };
}

} // namespace stromboli::stress

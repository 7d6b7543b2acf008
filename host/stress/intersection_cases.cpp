#include "host/stress/case.hpp"
#include "host/stress/oracle.hpp"
#include "scene/generate/hard_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::stress {

// --- Primitives ----------------------------------------------------------------------------------

// Primitives that are hard to hit, and rays that are hard to follow.

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

// --- Edges ---------------------------------------------------------------------------------------

// Rays at the edges and corners that triangles share: where a test that is not watertight lets
// them through.

namespace {

enum class Aim { Edges, Corners };

glm::vec3 target(const Scene& mesh, Aim aim, Random& random) {
    const Triangle& t = mesh.triangles[random.below(uint32_t(mesh.triangles.size()))];
    const uint32_t i = random.below(3);
    const glm::vec3 a = mesh.positions[t.corner[i]], b = mesh.positions[t.corner[(i + 1) % 3]];
    if (aim == Aim::Corners) return a;
    return random.below(2) ? 0.5f * (a + b) : a + random.uniform() * (b - a);
}

/// From within 0.1 of `middle`, directions of any length.
std::vector<Ray> raysAt(const Scene& mesh, const glm::vec3& middle, Aim aim, uint64_t count,
                        uint32_t seed) {
    return drawnRays(count, seed, [&](Random& random, uint64_t i) {
        const glm::vec3 origin = middle + random.inCube(0.1f);
        return rayTowards(origin, target(mesh, aim, random), i);
    });
}

/// Rays from inside closed meshes that leave them unnoticed.
Finding missesFromWithin(Run& run, const std::vector<uint32_t>& levels, const glm::vec3& middle,
                         const std::vector<Aim>& aims, uint64_t rays, uint32_t seed) {
    Finding f;
    Random random(seed);
    const uint64_t each = rays / (levels.size() * aims.size());
    for (const uint32_t level : levels) {
        Scene mesh = starMesh(level, random);
        translate(mesh, middle);
        const auto tracer = run.subject().tracer(mesh);
        for (const Aim aim : aims)
            countMisses(
                run, *tracer, each,
                [&](uint64_t count) { return raysAt(mesh, middle, aim, count, random.word()); },
                fmt::format("{} triangles", mesh.triangles.size()), f);
    }
    return f;
}

/// The levels of subdivision of the meshes, which have 8 * 4^level triangles.
std::vector<uint32_t> levels(const Run& run) {
    return run.quick() ? std::vector<uint32_t>{0, 1, 3} : std::vector<uint32_t>{0, 1, 3, 5};
}

Finding edges(Run& run) {
    return missesFromWithin(run, levels(run), {0, 0, 0}, {Aim::Edges},
                            run.amount<uint64_t>(300'000, 50'000'000), 1001);
}

Finding corners(Run& run) {
    return missesFromWithin(run, levels(run), {0, 0, 0}, {Aim::Corners},
                            run.amount<uint64_t>(300'000, 50'000'000), 1002);
}

/// Where Embree's watertight_pos has them: 1e5 of their size from the origin. Coordinates are
/// multiples of 1/64 there; the meshes are not so fine that corners would coincide.
Finding moved(Run& run) {
    return missesFromWithin(run, {0, 1, 2, 3}, {148376, 1234, -223423}, {Aim::Edges, Aim::Corners},
                            run.amount<uint64_t>(800'000, 100'000'000), 1003);
}

/// All coordinates are whole numbers, so that heights must come out to the last bit. Two
/// components of the direction are zero, of either sign, and origins lie in the planes of boxes.
Finding grid(Run& run) {
    const uint32_t n = run.amount(64u, 512u);
    Random random(1004);
    const Scene mesh = integerTerrain(n, random);
    std::vector<Ray> rays;
    std::vector<float> expected;
    for (uint32_t i = 0; i <= n; ++i)
        for (uint32_t j = 0; j <= n; ++j)
            for (const float zero : {0.0f, -0.0f}) {
                rays.push_back({{float(i), 10, float(j)}, kMissed, {zero, -1, zero}, 0});
                expected.push_back(10 - mesh.positions[i * (n + 1) + j].y);
            }
    const std::vector<float> found = run.subject().tracer(mesh)->distances(rays);
    Finding f;
    f.trials = rays.size();
    for (size_t i = 0; i < rays.size(); ++i) {
        if (found[i] == expected[i]) continue;
        ++f.measured;
        f.where = fmt::format("x {}, z {}: {}", rays[i].origin.x, rays[i].origin.z, found[i]);
    }
    return f;
}

/// A camera on the axis of a sphere of triangles, its rays through the corners of pixels: those of
/// the middle row and column pass along edges, through corners and through the pole.
Finding aligned(Run& run) {
    const int n = run.amount(256, 2048); // pixels across
    constexpr float kDistance = 3;
    Finding f;
    const std::vector<uint32_t> allRings =
        run.quick() ? std::vector<uint32_t>{4, 16} : std::vector<uint32_t>{4, 16, 64};
    for (const uint32_t rings : allRings) {
        const Scene mesh = tessellatedSphere(rings);
        std::vector<Ray> rays;
        for (int x = -n / 2; x <= n / 2; ++x)
            for (int y = -n / 2; y <= n / 2; ++y) {
                const glm::vec3 d(float(x) / float(n), float(y) / float(n), -1);
                // The line passes the centre at kDistance sin(angle to the axis); the polyhedron
                // holds a ball of radius cos^2(pi / (2 rings)).
                const float sine = std::sqrt(1 - 1 / glm::dot(d, d));
                const float ball = float(std::pow(std::cos(M_PI / (2 * rings)), 2));
                if (kDistance * sine < 0.99f * ball)
                    rays.push_back({{0, 0, kDistance}, kMissed, d, 0});
            }
        const uint64_t missed = rays.size() - run.subject().tracer(mesh)->countHits(rays, false);
        if (missed > 0) f.where = fmt::format("{} rings", rings);
        f.measured += double(missed);
        f.trials += rays.size();
        run.goOn();
    }
    return f;
}

} // namespace

std::vector<Case> edgeCases() {
    return {
        {"edges", "1", "rays at shared edges of closed random meshes hit", "missed", "rays", edges},
        {"corners", "2", "rays at corners of closed random meshes hit", "missed", "rays", corners},
        {"moved-meshes", "3", "the same 1e5 of their size from the origin", "missed", "rays",
         moved},
        {"integer-grid", "4", "axis-parallel rays through the corners of a grid hit, exactly",
         "wrong", "rays", grid},
        {"aligned-camera", "5", "no holes in a sphere of triangles seen along its axis", "missed",
         "rays", aligned},
    };
}

} // namespace stromboli::stress

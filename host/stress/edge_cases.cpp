// Rays at the edges and corners that triangles share: where a test that is not watertight lets
// them through.
#include "host/stress/case.hpp"
#include "host/stress/drawn_rays.hpp"
#include "scene/generate/hard_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::stress {
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

/// Of the meshes: they have 8 * 4^level triangles.
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

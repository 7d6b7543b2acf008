#include "host/stress/case.hpp"
#include "host/stress/oracle.hpp"
#include "host/stress/scenes.hpp"
#include "scene/build/polygon.hpp"
#include "scene/build/scene_builder.hpp"
#include "scene/generate/hard_meshes.hpp"
#include "scene/model/placements.hpp"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::stress {

// --- Instances -----------------------------------------------------------------------------------

// Meshes that are met through placements: turned, stretched, mirrored, small in a large world.

namespace {

/// A turn without a zero in it, a stretch of up to ten in each direction, and every other time a
/// mirror.
Placement randomPlacement(const glm::vec3& at, float size, Random& random) {
    const glm::dquat turn =
        glm::normalize(glm::dquat(random.uniform(0.1f, 1), random.uniform(-1, 1),
                                  random.uniform(0.1f, 1), random.uniform(-1, 1)));
    glm::dmat3 linear = glm::mat3_cast(turn);
    for (int axis = 0; axis < 3; ++axis)
        linear[axis] *= double(size) * double(random.ofAnySize(0.316f, 3.16f));
    if (random.below(2) == 1) linear[0] = -linear[0];
    glm::dmat4 matrix(linear * glm::mat3_cast(glm::conjugate(turn)) *
                      glm::mat3_cast(glm::angleAxis(1.0, glm::dvec3(0.6, 0, 0.8))));
    matrix[3] = glm::dvec4(at, 1);
    return *placementOf(matrix);
}

/// The mesh at `count` places of a cube of this half width about `middle`.
Scene placedMany(Scene mesh, uint32_t count, float size, const glm::vec3& middle, float half,
                 Random& random) {
    mesh.prototypes.push_back({0, uint32_t(mesh.triangles.size())});
    for (uint32_t i = 0; i < count; ++i)
        mesh.placements.push_back(randomPlacement(middle + random.inCube(half), size, random));
    return mesh;
}

/// A point of an edge of some placement, or one of its ends.
glm::vec3 edgePoint(const Scene& scene, const Placement& p, Random& random) {
    const Triangle& t = scene.triangles[random.below(uint32_t(scene.triangles.size()))];
    const uint32_t i = random.below(3);
    const glm::vec3 a = stromboli::placed(p, scene.positions[t.corner[i]]);
    const glm::vec3 b = stromboli::placed(p, scene.positions[t.corner[(i + 1) % 3]]);
    switch (random.below(3)) {
    case 0:
        return a;
    case 1:
        return 0.5f * (a + b);
    default:
        return a + random.uniform() * (b - a);
    }
}

/// From near the middles of placements to their edges.
std::vector<Ray> raysFromWithin(const Scene& scene, uint64_t count, uint32_t seed) {
    return drawnRays(count, seed, [&](Random& random, uint64_t i) {
        const Placement& p = scene.placements[random.below(uint32_t(scene.placements.size()))];
        const glm::vec3 origin = stromboli::placed(p, random.inCube(0.1f));
        return rayTowards(origin, edgePoint(scene, p, random), i);
    });
}

struct World {
    float size, half; ///< of a mesh, and half the width of the cube that they are in
    glm::vec3 middle;
};

/// Meshes of a thousandth, of the same and of a thousand times the world's size, and far away.
const World kWorlds[] = {{1, 20, {0, 0, 0}},
                         {1e-3f, 1, {3, -2, 1}},
                         {1e3f, 1, {0, 0, 0}},
                         {1, 10, {148376, 1234, -223423}}};

Finding edgesOfInstances(Run& run) {
    Finding f;
    Random random(1101);
    const std::vector<uint32_t> levels =
        run.quick() ? std::vector<uint32_t>{0, 2} : std::vector<uint32_t>{0, 1, 3, 5};
    const uint64_t each =
        run.amount<uint64_t>(400'000, 100'000'000) / (levels.size() * std::size(kWorlds));
    for (const World& world : kWorlds)
        for (const uint32_t level : levels) {
            const Scene scene = placedMany(starMesh(level, random), 16, world.size, world.middle,
                                           world.half, random);
            const auto tracer = run.subject().tracer(scene);
            countMisses(
                run, *tracer, each,
                [&](uint64_t count) { return raysFromWithin(scene, count, random.word()); },
                fmt::format("{} triangles of size {:g}", scene.triangles.size(), world.size), f);
        }
    return f;
}

/// From anywhere in the world, and from up to a thousand times as far, to edges of placements.
std::vector<Ray> raysFromOutside(const Scene& scene, const World& world, uint32_t count,
                                 Random& random) {
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < count; ++i) {
        const Placement& p = scene.placements[random.below(uint32_t(scene.placements.size()))];
        const float away = random.ofAnySize(1, 1e3f);
        const glm::vec3 origin = world.middle + random.inCube(world.half * away);
        const glm::vec3 direction = edgePoint(scene, p, random) - origin;
        if (direction != glm::vec3(0)) rays.push_back({origin, kMissed, direction, 0});
    }
    return rays;
}

/// Copies have the corners of instances to the last bit, so that the same rays hit, and distances
/// are those of the same test. Pairs of triangles may begin at other corners, which changes how a
/// distance is rounded: by 23 u each way (docs/theory/numerics.md, "Boxes") of the distance and of
/// how far a triangle reaches along the ray, 1.4 for its corners times 3.16 for the stretch, on
/// both sides.
Finding asCopies(Run& run) {
    constexpr float kRounding = 46 * 0x1p-24f;
    Finding f;
    Random random(1102);
    for (const World& world : kWorlds) {
        const Scene scene =
            placedMany(starMesh(2, random), 16, world.size, world.middle, world.half, random);
        const auto rays = raysFromOutside(scene, world, run.amount(40'000u, 2'000'000u), random);
        const std::vector<float> found = run.subject().tracer(scene)->distances(rays);
        const Scene copies = expandPlacements(scene).scene;
        const std::vector<float> expected = run.subject().tracer(copies)->distances(rays);
        for (size_t i = 0; i < rays.size(); ++i) {
            const float difference = std::abs(found[i] - expected[i]);
            const float reach = 2 * 1.4f * 3.16f * world.size / glm::length(rays[i].direction);
            const bool same =
                found[i] == expected[i] || difference <= kRounding * (expected[i] + reach);
            if (same) continue;
            ++f.measured;
            f.where = fmt::format("size {:g}: {} instead of {}", world.size, found[i], expected[i]);
        }
        f.trials += rays.size();
        run.goOn();
    }
    return f;
}

/// The camera is inside of a closed mesh and all light outside: whatever the picture shows has come
/// through the surface.
Finding closed(Run& run) {
    Finding f;
    Random random(1103);
    const uint32_t side = run.amount(32u, 128u);
    // Rays start some 32 u of their coordinates beside the surface, which far away is more than a
    // facet; and a star's surfaces meet at angles that are too sharp for any offset.
    const World worlds[] = {kWorlds[0], kWorlds[1], kWorlds[2], {1, 0, {2000, -1000, 300}}};
    for (const World& world : worlds) {
        Scene scene = placedMany(tessellatedSphere(8), 1, world.size, world.middle, 0, random);
        scene.materials[0].albedo = glm::vec3(0.9f);
        scene.lights.push_back(ambient(1));
        Camera camera;
        camera.position = glm::dvec3(stromboli::placed(scene.placements[0], glm::vec3(0)));
        const Picture picture =
            run.render(scene, camera, stress::picture(side, run.amount(4u, 16u), 16));
        for (const PixelStatistics& p : picture.film.pixels)
            if (p.mean != glm::dvec3(0)) {
                ++f.measured;
                f.where = fmt::format("size {:g}", world.size);
            }
        f.trials += picture.rays;
    }
    return f;
}

/// Coordinates of a country, where floats are half a metre apart.
const glm::dvec3 kFarAway{4567890.25, 123.5, 5432100.75};
constexpr double kStep = 0.05; // metres
constexpr int kSteps = 100;

/// A stair, whose step i has the height i * kStep, as a loader hands it over: the mesh has these
/// coordinates itself, or a node brings it there.
Scene farStair(bool byNode) {
    build::SceneBuilder builder("town.xyz", {});
    const glm::dvec3 from = byNode ? glm::dvec3(0) : kFarAway, to = kFarAway - from;
    build::Mesh mesh;
    build::MeshPart part;
    build::PolygonCutter cut(mesh, builder.report());
    for (int i = 0; i < kSteps; ++i) {
        const auto first = uint32_t(mesh.positions.size());
        std::array<build::Corner, 4> corners;
        for (uint32_t c = 0; c < 4; ++c) {
            const glm::dvec3 p(c == 1 || c == 2 ? 1 : 0, i * kStep, (i + (c > 1 ? 1 : 0)) * kStep);
            mesh.positions.push_back(from + p);
            corners[c] = {first + c, kNoNormals};
        }
        cut.add(corners, part);
    }
    mesh.parts.push_back(std::move(part));
    mesh.isFlat = true;
    const std::array<uint32_t, 1> materials{builder.defaultMaterial()};
    builder.place({"town.xyz", 1, "stair"}, builder.addMesh("stair", mesh),
                  glm::translate(glm::dmat4(1), to), materials, "stair");
    return builder.finish();
}

/// Rays straight down onto each step. Coordinates are below 16 m from the scene's own origin, so
/// that a vertex, the ray's origin and its distance are off by 2^-21 m each.
Finding farFiles(Run& run) {
    Finding f;
    f.bound = 0x1p-19;
    for (const bool byNode : {false, true}) {
        const Scene scene = farStair(byNode);
        const auto tracer = run.subject().tracer(scene);
        std::vector<Ray> rays;
        for (int i = 0; i < kSteps; ++i)
            for (const double along : {0.25, 0.5, 0.75}) {
                const glm::dvec3 above(along, i * kStep + 1, (i + along) * kStep);
                const glm::vec3 origin(kFarAway + above - scene.origin);
                rays.push_back({origin, kMissed, glm::vec3(0, -1, 0), 0});
            }
        for (const float distance : tracer->distances(rays))
            f.measured = std::max(f.measured, std::abs(double(distance) - 1));
        f.trials += rays.size();
        run.goOn();
    }
    return f;
}

} // namespace

std::vector<Case> instanceCases() {
    return {
        {"instances", "75", "rays at edges and corners of closed meshes that are placed hit",
         "missed", "rays", edgesOfInstances},
        {"instances-as-copies", "76", "instances are met where copies are", "wrong", "rays",
         asCopies},
        {"closed-instances", "77", "no light comes through closed meshes that are placed", "lit",
         "rays", closed},
        {"far-files", "78", "steps of 5 cm, 7,000 km from the file's origin, keep their height",
         "m off", "rays", farFiles},
    };
}

} // namespace stromboli::stress

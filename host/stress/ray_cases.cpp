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

// --- Ends of rays --------------------------------------------------------------------------------

// Where rays start and end: on the right side of every surface, whatever its size and place.

namespace {

/// Two parallel floors, 1e-4 of their size apart, under a directional light. A camera whose near
/// plane lies between the two sees the lower one, which must be black; one above sees the upper
/// one.
Finding parallelPlanes(Run& run) {
    SceneMaker m;
    const uint32_t white = m.add(diffuse(0.5f));
    for (const float height : {0.0f, 1e-4f})
        m.quad({-0.5f, height, -0.5f}, {0, 0, 1}, {1, 0, 0}, white);
    Light sun;
    sun.kind = LightKind::Directional;
    sun.direction = glm::normalize(glm::vec3(0.1f, -1, 0.2f));
    m.add(sun);
    const double lit = 0.5 / M_PI * -double(sun.direction.y);
    Camera above = lookingAt({0, 0.5, 0}, {0, 0, 0}, 0.2);
    above.orthographic = true;
    Camera between = above;
    between.nearDistance = 0.5 - 0.5e-4;
    Finding f;
    f.bound = kRounding;
    const RenderSettings s = picture(64, run.amount(4u, 64u), 3);
    for (const float scale : sizes(run)) {
        const auto mean = [&](Camera camera) {
            camera.halfWidth *= scale, camera.halfHeight *= scale, camera.nearDistance *= scale;
            f.trials += uint64_t(s.area.width) * s.area.height * s.budget.mostSamplesPerPixel;
            return Totals(run.render(placed(m.scene, scale), placed(camera, scale), s).film)
                .all.mean.x;
        };
        const double leaked = mean(between) / lit, lost = std::abs(mean(above) / lit - 1);
        if (!(std::max(leaked, lost) <= f.measured)) {
            f.measured = std::max(leaked, lost);
            f.where =
                fmt::format("{} at size {}", leaked > lost ? "lower floor" : "upper floor", scale);
        }
    }
    return f;
}

/// An emitter just over a floor: shadow rays must end before it, however short they are. Each pixel
/// is one sample, which is black only if the emitter shades itself.
Finding emittersNearFloors(Run& run) {
    Finding f;
    const RenderSettings s = picture(run.amount(64u, 512u), 1, 1);
    const std::vector<float> heights = run.quick() ? std::vector<float>{1e-5f, 1e5f}
                                                   : std::vector<float>{1e-5f, 1e-3f, 1.0f, 1e5f};
    for (const float height : heights)
        for (const float scale : sizes(run))
            for (const bool round : {false, true}) {
                SceneMaker m;
                const uint32_t white = m.add(diffuse(0.5f)), light = m.add(emissive(1, false));
                const float size = std::min(height, 1.0f); // of the emitter
                m.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white);
                if (round)
                    m.sphere({0, height + size, 0}, size, light);
                else
                    m.quad({-size, height, -size}, {2 * size, 0, 0}, {0, 0, 2 * size}, light);
                Camera camera = lookingAt({0, 0.5 * height, 0}, {0, 0, 0}, 0.5);
                if (height > 1) camera = lookingAt({0.3, 0.5, 0.1}, {0, 0, 0}, 0.5);
                const Film film = run.render(placed(m.scene, scale), placed(camera, scale), s).film;
                for (const PixelStatistics& p : film.pixels) {
                    if (p.mean.x > 0) continue;
                    ++f.measured;
                    f.where = fmt::format("{} {} over the floor, size {}",
                                          round ? "sphere" : "quad", height, scale);
                }
                f.trials += film.pixels.size();
            }
    return f;
}

/// A floor whose shading normal is tilted, emitters below it: nothing arrives above, however a
/// light is found, and nothing comes from the dark side of an emitter above it.
Finding leaks(Run& run) {
    Finding f;
    for (const Material& material : {diffuse(0.5f), metal(0.8f), mirror(1)})
        for (const DirectLight mode : kDirectLightModes)
            for (const bool flipped : {false, true}) {
                if (run.quick() && flipped == (mode == DirectLight::Bsdf)) continue;
                SceneMaker m;
                const uint32_t surface = m.add(material), light = m.add(emissive(1, false));
                m.quad({-1, 0, -1}, flipped ? glm::vec3(2, 0, 0) : glm::vec3(0, 0, 2),
                       flipped ? glm::vec3(0, 0, 2) : glm::vec3(2, 0, 0), surface);
                m.scene.normals = {{0.8f, flipped ? -0.6f : 0.6f, 0}};
                for (Triangle& t : m.scene.triangles)
                    std::fill_n(t.normals, 3, 0u);
                m.sphere({2, -0.4f, 0}, 0.35f, m.add(emissive(1, true))); // below the floor
                m.quad({-1, 0.75f, -1}, {0, 0, 2}, {2, 0, 0}, light);     // faces away
                Light point;
                point.position = {2, -0.2f, 0};
                m.add(point);
                RenderSettings s = picture(32, run.amount(8u, 256u), 4);
                s.estimator.minBounce = 1;
                s.estimator.directLight = mode;
                const Camera camera = lookingAt({0.5, 0.5, 0}, {0, 0, 0}, 0.5);
                const Film film = run.render(m.scene, camera, s).film;
                const double leaked = Totals(film).sum();
                if (leaked > 0) f.where = fmt::format("mode {}", nameOf(mode));
                f.measured += leaked;
                f.trials += uint64_t(s.area.width) * s.area.height * s.budget.mostSamplesPerPixel;
            }
    return f;
}

} // namespace

std::vector<Case> offsetCases() {
    return {
        {"parallel-planes", "34", "of two floors 1e-4 of their size apart the upper one is lit",
         "share of the light", "samples", parallelPlanes},
        {"emitters-near-floors", "35", "emitters 1e-5 to 1e5 away do not shade themselves", "black",
         "samples", emittersNearFloors},
        {"leaks", "51", "no light comes through an opaque surface", "light", "samples", leaks},
    };
}

// --- Closed surfaces -----------------------------------------------------------------------------

// Rays that leave surfaces, many times over: none meets the surface it leaves, none gets through a
// wall.

namespace {

/// A body with its ambient light and a camera that sees nothing else.
struct Body {
    const char* name;
    Scene scene;
    Camera camera;
};

/// Convex, seen from outside: a ray that leaves them meets nothing. All their light is scattered.
std::vector<Body> convexBodies() {
    const Camera camera = lookingAt({3, 2, 4}, {0, 0, 0}, 0.05);
    std::vector<Body> bodies;
    const auto add = [&](const char* name, SceneMaker m) {
        m.add(ambient(1));
        bodies.push_back({name, m.scene, camera});
    };
    SceneMaker cube, ball, brick;
    cube.box({-1, -1, -1}, {1, 1, 1}, cube.add(diffuse(1)));
    ball.sphere({0, 0, 0}, 1, ball.add(diffuse(1)));
    brick.box({-1, -1, -1}, {1, 1, 1}, brick.add(diffuse(1)));
    brick.scene = turned(brick.scene);
    add("cube", cube);
    add("turned cube", brick);
    add("sphere", ball);
    return bodies;
}

/// Light that is scattered twice or more by a convex body has met it twice.
Finding selfHits(Run& run) {
    RenderSettings s = picture(64, run.amount(16u, 128u), 4);
    s.estimator.minBounce = 2;
    s.estimator.directLight = DirectLight::Bsdf;
    const std::vector<Body> bodies = convexBodies();
    std::vector<float> scales = sizes(run);
    if (!run.quick()) scales.insert(scales.end(), {1e-8f, 1e8f});
    Finding f;
    for (const Body& body : bodies)
        for (const float scale : scales)
            for (const float shift : {0.0f, 100.0f}) { // in units of the body
                if (run.quick() && (scale > 1) == (shift == 0)) continue;
                const glm::vec3 by = shift * scale * glm::vec3(0.7f, -0.6f, 1);
                const Film film =
                    run.render(placed(body.scene, scale, by), placed(body.camera, scale, by), s)
                        .film;
                const double again = Totals(film).sum();
                if (again > 0) f.where = fmt::format("{} of size {}", body.name, scale);
                f.measured += again;
                f.trials += uint64_t(s.area.width) * s.area.height * s.budget.mostSamplesPerPixel;
            }
    return f;
}

/// Closed rooms without an emitter in ambient light: what light there is has come through a wall.
/// Walls reflect all, so that every escape counts 1, and paths that ended early would be missing
/// rays.
std::vector<Body> closedRooms() {
    const Camera camera = lookingAt({0.1, -0.2, 0.3}, {0.7, 0.4, -0.1}, 1.5);
    std::vector<Body> rooms;
    const auto add = [&](const char* name, SceneMaker m) {
        m.add(ambient(1));
        rooms.push_back({name, m.scene, camera});
    };
    SceneMaker room, turnedRoom, ball, furnished;
    room.box({-1, -1, -1}, {1, 1, 1}, room.add(diffuse(1)), true);
    turnedRoom.box({-1, -1, -1}, {1, 1, 1}, turnedRoom.add(diffuse(1)), true);
    turnedRoom.scene = turned(turnedRoom.scene);
    ball.sphere({0, 0, 0}, 1, ball.add(diffuse(1)));
    const uint32_t wall = furnished.add(diffuse(1)), shiny = furnished.add(mirror(1));
    furnished.box({-1, -1, -1}, {1, 1, 1}, wall, true);
    furnished.box({-0.9f, -1, -0.9f}, {-0.4f, -0.5f, -0.4f}, shiny); // stands on the floor
    furnished.sphere({0.5f, -0.5f, -0.5f}, 0.5f, wall);              // touches floor and wall
    add("room", room);
    add("turned room", turnedRoom);
    add("sphere", ball);
    add("furnished room", furnished);
    return rooms;
}

Finding escapes(Run& run) {
    constexpr uint32_t kBounces = 100;
    // 1e7 bounces for each scale, on all rooms together.
    RenderSettings s = picture(16, run.amount(2u, 100u), kBounces);
    s.estimator.directLight = DirectLight::Bsdf;
    const std::vector<Body> rooms = closedRooms();
    Finding f;
    for (const float scale : sizes(run))
        for (const Body& room : rooms) {
            const Picture p = run.render(placed(room.scene, scale), placed(room.camera, scale), s);
            const Totals totals(p.film);
            // Each path traces a ray from the camera and one after each bounce.
            const uint64_t expected = uint64_t(totals.all.taken()) * (kBounces + 1);
            const double missing = double(expected) - double(p.rays);
            if (totals.sum() + missing > 0)
                f.where = fmt::format("{} of size {}", room.name, scale);
            f.measured += std::max(totals.sum(), missing);
            f.trials += expected;
        }
    return f;
}

} // namespace

std::vector<Case> closedCases() {
    return {
        {"self-hits", "14, 30", "rays that leave a convex body do not meet it again, 1e-8 to 1e8",
         "self-hits", "paths", selfHits},
        {"escapes", "15", "no ray gets out of a closed room, 1e-6 to 1e6", "escapes", "rays",
         escapes},
    };
}

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

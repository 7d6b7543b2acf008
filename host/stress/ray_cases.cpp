#include "host/stress/case.hpp"
#include "host/stress/oracle.hpp"
#include "host/stress/scenes.hpp"
#include "scene/generate/hard_meshes.hpp"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
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

} // namespace stromboli::stress

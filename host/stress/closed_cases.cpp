// Rays that leave surfaces, many times over: none meets the surface it leaves, none gets through a
// wall.
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"
#include "host/stress/totals.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::stress {
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

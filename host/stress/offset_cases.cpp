// Where rays start and end: on the right side of every surface, whatever its size and place.
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"
#include "host/stress/totals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::stress {
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

} // namespace stromboli::stress

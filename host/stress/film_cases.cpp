// Sums of many samples, samples that must be left out, and how the work is cut.
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"
#include "host/stress/totals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace stromboli::stress {
namespace {

/// Inside an emitter: every sample is its radiance.
Scene insideEmitter(const glm::vec3& radiance) {
    SceneMaker m;
    Material glow = emissive(1, true);
    glow.emission = radiance;
    m.sphere({0, 0, 0}, 1, m.add(glow));
    return m.scene;
}

const Camera kInside = lookingAt({0, 0, 0}, {0, 0, 1}, 1);

/// Powers of two would add up without rounding.
Finding manySamples(Run& run) {
    const glm::vec3 value(0.5f, 0.1f, 0.7f);
    RenderSettings s = picture(4, run.amount(200'000u, 10'000'000u), 0);
    const Film film = run.render(insideEmitter(value), kInside, s).film;
    Finding f;
    f.bound = 1e-6;
    for (const PixelStatistics& p : film.pixels) {
        f.trials += p.count;
        for (int c = 0; c < 3; ++c) {
            const double off = std::abs(p.mean[c] - double(value[c]));
            // The running mean is rounded to float where deviations from it are formed.
            const double spread = std::sqrt(p.variance()[c]) - 0x1p-23 * double(value[c]);
            const double worst =
                p.count == s.budget.mostSamplesPerPixel ? std::max(off, spread) : 1;
            if (!(worst <= f.measured)) f.measured = worst, f.where = fmt::format("{}", value[c]);
        }
    }
    return f;
}

/// A wall of nine emitters, the middle one of a radiance that is none.
Finding badSamples(Run& run) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    Finding f;
    for (const float bad : {kNaN, -kNaN, kInfinity, -kInfinity, -1.0f, 1e38f, 0x1.000002p48f}) {
        SceneMaker m;
        const uint32_t good = m.add(emissive(0.25f, true));
        Material wrong = emissive(1, true);
        wrong.emission = {0.5f, bad, 0.5f};
        const uint32_t middle = m.add(wrong);
        for (int i = -1; i <= 1; ++i)
            for (int k = -1; k <= 1; ++k)
                m.quad({float(i) - 0.5f, float(k) - 0.5f, 0}, {1, 0, 0}, {0, 1, 0},
                       i == 0 && k == 0 ? middle : good);
        Camera camera = lookingAt({0, 0, 1}, {0, 0, 0}, 1.5);
        camera.orthographic = true;
        const RenderSettings s = picture(3 * 8, run.amount(5u, 500u), 0);
        const Film film = run.render(m.scene, camera, s).film;
        for (uint32_t y = 0; y < s.area.height; ++y)
            for (uint32_t x = 0; x < s.area.width; ++x) {
                const PixelStatistics& p = film.at(x, y);
                const bool spoilt = x / 8 == 1 && y / 8 == 1;
                const uint32_t n = s.budget.mostSamplesPerPixel;
                const bool right = spoilt ? p.count == 0 && p.rejected == n && p.firstRejected == 0
                                          : p.count == n && p.mean == glm::dvec3(0.25);
                if (right) continue;
                f.measured += 1;
                f.where = fmt::format("radiance {}", bad);
            }
        f.trials += film.pixels.size();
    }
    return f;
}

bool sameBits(const PixelStatistics& a, const PixelStatistics& b) {
    return a.count == b.count && a.rejected == b.rejected &&
           std::memcmp(&a.mean, &b.mean, sizeof a.mean) == 0 &&
           std::memcmp(&a.m2, &b.m2, sizeof a.m2) == 0;
}

/// The same picture to the last bit, whatever the workgroups, lanes, dispatches and ways to fetch.
Finding cuts(Run& run) {
    const Scene scene = cornellBox();
    const Camera camera = lookingAt({0.5, 0.5, 0.9375}, {0.5, 0.4375, 0}, 0.75);
    RenderSettings s = picture(run.amount(24u, 128u), run.amount(8u, 64u), 6);
    s.area.width += 5; // no multiple of a tile or a workgroup
    std::vector<KernelTuning> tunings = {{.workgroupSize = 8},     {.workgroupSize = 32},
                                         {.workgroupSize = 64},    {.traversalSteps = 3},
                                         {.registerStack = 0},     {.lanes = 100},
                                         {.itemsPerDispatch = 77}, {.fixedIterations = 9}};
    for (const bool texel : {false, true})
        tunings.push_back({.texelFetch = texel});
    const Film whole = run.render(scene, camera, s).film;
    Finding f;
    for (size_t i = 0; i < tunings.size(); ++i) {
        const Film other = run.render(scene, camera, s, tunings[i]).film;
        for (size_t k = 0; k < whole.pixels.size(); ++k)
            f.measured += !sameBits(whole.pixels[k], other.pixels[k]);
        if (f.measured > 0 && f.where.empty()) f.where = fmt::format("way {} to cut", i + 1);
        f.trials += whole.pixels.size();
    }
    return f;
}

/// Pictures of shapes that fit nothing, with the fewest samples and bounces; scenes with nothing in
/// them; a camera inside an object. Every pixel has its samples, none is rejected.
Finding shapes(Run& run) {
    Finding f;
    const auto check = [&](const char* what, const Scene& scene, const Camera& camera,
                           const RenderSettings& s, bool lit) {
        for (const PixelStatistics& p : run.render(scene, camera, s).film.pixels) {
            const bool right = p.count == s.budget.mostSamplesPerPixel && p.rejected == 0 &&
                               (lit ? p.mean.x > 0 : p.mean == glm::dvec3(0.0));
            if (!right) f.measured += 1, f.where = what;
            ++f.trials;
        }
    };
    const Scene glow = insideEmitter(glm::vec3(0.5f));
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {1u, 17u}, {7u, 13u}, {run.amount(4000u, 16384u), 1u}})
        for (const uint32_t bounces : {0u, 1u}) {
            RenderSettings s = picture(1, 1, bounces);
            s.area.width = width, s.area.height = height;
            check("shape", glow, kInside, s, true);
        }
    check("empty scene", Scene{}, kInside, picture(9, 3, 5), false);
    SceneMaker dark, ball;
    dark.box({-1, -1, -1}, {1, 1, 1}, dark.add(diffuse(0.5f)), true);
    check("no lights", dark.scene, kInside, picture(9, 3, 5), false);
    ball.sphere({0, 0, 0}, 1, ball.add(glass(1.5f)));
    ball.sphere({0, 0, 0}, 10, ball.add(emissive(1, true)));
    check("camera in glass", ball.scene, kInside, picture(9, 3, 100), true);
    return f;
}

} // namespace

std::vector<Case> filmCases() {
    return {
        {"many-samples", "54", "the mean of 1e7 equal samples", "difference", "samples",
         manySamples},
        {"bad-samples", "60", "NaN, infinite, negative, huge samples are left out and counted",
         "wrong", "pixels", badSamples},
        {"cuts", "59, 63", "the same bits, however the work is cut", "different", "pixels", cuts},
        {"shapes", "65", "pictures and scenes of unusual shape", "wrong", "pixels", shapes},
    };
}

} // namespace stromboli::stress

// Different ways to the same mean.
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"
#include "host/stress/totals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::stress {
namespace {

/// A difference beyond 3 sigma is measured again, with other random numbers and four times the
/// samples, and counts if it is still there.
template <class Measure>
double confirmed(RenderSettings s, const Measure& sigmas) {
    double z = 0;
    for (int attempt = 0; attempt < 2; ++attempt) {
        z = sigmas(s);
        if (z <= 3) break;
        s.budget.mostSamplesPerPixel *= 4;
        s.estimator.seed += 1000;
    }
    return z;
}

/// In a closed furnace light scattered k times has radiance a^k: sums of it from k = n to m, with
/// and without roulette.
Finding partialSums(Run& run) {
    constexpr double kAlbedo = 0.5;
    SceneMaker m;
    m.sphere({0, 0, 0}, 1, m.add(diffuse(float(kAlbedo), 1)));
    const Camera camera = lookingAt({0.1, 0.2, 0.3}, {0.7, -0.4, 0.1}, 1);
    const std::vector<Roulette> roulettes = {
        {Roulette::Mode::None, 0}, {Roulette::Mode::Throughput, 0}, {Roulette::Mode::Fixed, 0.3}};
    Finding f;
    f.bound = 3;
    for (const Roulette& roulette : roulettes)
        for (uint32_t least = 0; least <= 8; least += run.amount(4u, 1u)) {
            RenderSettings s = picture(16, run.amount(32u, 512u), run.quick() ? 8 : least + 4);
            s.estimator.minBounce = least;
            s.estimator.roulette = roulette;
            double expected = 0;
            for (uint32_t k = least; k <= s.estimator.maxBounces; ++k)
                expected += std::pow(kAlbedo, k);
            const double z = confirmed(s, [&](const RenderSettings& now) {
                const Totals totals(run.render(m.scene, camera, now).film);
                f.trials += totals.all.taken();
                return sigmasOff(totals, glm::dvec3(expected));
            });
            if (!(z <= f.measured))
                f.measured = z,
                f.where = fmt::format("{} to {} scatterings", least, s.estimator.maxBounces);
        }
    return f;
}

struct EmitterCase {
    const char* name;
    float size, height;
    bool bothSides, faceAway;
    bool standing = false; ///< upright, its lower edge at `height`
};

/// An emitter over a floor, in a box without a roof; `pieces` per side of it, each an emitter
/// of its own or all one mesh.
Scene emitterInBox(const EmitterCase& l, int pieces, bool oneMesh) {
    SceneMaker m;
    const float size = l.size;
    const uint32_t white = m.add(diffuse(0.6f)),
                   light = m.add(emissive(1 / (size * size), l.bothSides));
    m.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white);
    m.quad({-1, 0, -1}, {2, 0, 0}, {0, 1, 0}, white); // a wall that the emitter's back can light
    const float step = size / float(pieces);
    for (int i = 0; i < pieces; ++i)
        for (int k = 0; k < pieces; ++k) {
            const glm::vec3 x(step, 0, 0),
                other = l.standing ? glm::vec3(0, step, 0) : glm::vec3(0, 0, step);
            const glm::vec3 corner = l.standing ? glm::vec3(-0.5f * size, l.height, 0)
                                                : glm::vec3(-0.5f * size, l.height, -0.5f * size);
            m.quad(corner + float(i) * x + float(k) * other, l.faceAway ? other : x,
                   l.faceAway ? x : other, light);
        }
    if (oneMesh)
        for (Triangle& t : m.scene.triangles)
            if (t.material == light) t.instance = 2;
    return m.scene;
}

/// What lights the scene is the same emitter, however it is cut up and however it is found.
Finding emitterInPieces(Run& run) {
    const std::vector<EmitterCase> emitters = {{"small", 0.05f, 0.5f, false, false},
                                               {"large", 1.5f, 0.5f, false, false},
                                               {"one-sided, facing away", 0.5f, 0.5f, false, true},
                                               {"two-sided, facing away", 0.5f, 0.5f, true, true},
                                               {"touching", 0.5f, 0, true, false, true}};
    const Camera camera = lookingAt({0.3, 0.4, 0.9}, {0, 0, -0.3}, 0.6);
    Finding f;
    f.bound = 3;
    for (const EmitterCase& l : emitters) {
        if (run.quick() && l.size != 0.5f) continue;
        const auto scene = [&](int pieces, bool oneMesh) {
            return emitterInBox(l, pieces, oneMesh);
        };
        const auto totals = [&](const Scene& lit, RenderSettings s, DirectLight mode) {
            s.estimator.directLight = mode;
            s.estimator.minBounce = 1; // not the emitter itself
            const Totals t(run.render(lit, camera, s).film);
            f.trials += t.all.taken();
            return t;
        };
        const RenderSettings s = picture(16, run.amount(64u, 2048u), 3);
        const Totals one = totals(scene(1, false), s, DirectLight::Mis);
        const auto compare = [&](const char* what, const Scene& other, DirectLight mode) {
            const double z = confirmed(s, [&](RenderSettings now) {
                now.estimator.seed += 1; // not that of `one`
                return sigmasOff(totals(other, now, mode), one);
            });
            if (!(z <= f.measured))
                f.measured = z, f.where = fmt::format("{} emitter, {}", l.name, what);
        };
        compare("100 emitters", scene(10, false), DirectLight::Mis);
        compare("a mesh of 200 triangles", scene(10, true), DirectLight::Mis);
        compare("by hemisphere", scene(1, false), DirectLight::Hemisphere);
        if (l.size > 0.1f) compare("by bounces", scene(1, false), DirectLight::Bsdf);
    }
    return f;
}

} // namespace

std::vector<Case> estimatorCases() {
    return {
        {"partial-sums", "49", "light of 0 to 12 scatterings, with and without roulette", "sigma",
         "samples", partialSums},
        {"emitter-in-pieces", "50", "one emitter, 100 pieces, any way to find it: the same light",
         "sigma", "samples", emitterInPieces},
    };
}

} // namespace stromboli::stress

#include "host/reference/microfacet.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace stromboli::stress {

// Principled materials at the ends of their parameters.

namespace {

/// How far a white material may be from keeping all light: errors of the fitted albedos
/// (docs/theory/surfaces.md, "Principled": 0.4 % and 0.0075 together).
constexpr double kAlbedoFits = 0.0117;
/// Standard errors: a right renderer exceeds them once in 1e5 times.
constexpr double kSigmasOfShares = 4.5;

Material principled(float metallic, float roughness) {
    Material m;
    m.kind = MaterialKind::Principled;
    m.principled.metallic = metallic;
    m.principled.roughness = roughness;
    return m;
}

bool hasRejected(const Film& film) {
    return std::ranges::any_of(film.pixels, [](const PixelStatistics& p) {
        return p.rejected > 0 || !(p.mean.x >= 0 && std::isfinite(p.mean.x));
    });
}

/// White metal of the least roughness, GGX's alpha 1e-4, in light 1 from everywhere, of which light
/// samples find as much as bounces: 1 within the error of its fitted albedo, and what the reference
/// finds. Where the cosine is no more than alpha, the lobe reaches below the surface. In shares of
/// what is allowed; a sample that is not finite is infinitely much.
Finding grazingGgx(Run& run) {
    SceneMaker m;
    m.quad({-100, 0, -100}, {0, 0, 200}, {200, 0, 0}, m.add(principled(1, 0.01f)));
    Environment white; // of more than one texel, as one is light that is not sampled
    white.width = 4, white.height = 2;
    white.radiance.assign(8, glm::vec3(1));
    m.scene.environment = white;
    Finding f;
    f.bound = 1;
    const std::vector<double> cosines =
        run.quick() ? std::vector<double>{1e-4, 1e-2}
                    : std::vector<double>{1e-4, 3e-4, 1e-3, 1e-2, 0.1, 0.5, 1};
    for (const double cosine : cosines) {
        const RenderSettings s = picture(16, run.amount(16u, 1024u), 1);
        const glm::dvec3 from(std::sqrt(1 - cosine * cosine), cosine, 0);
        const Camera camera = lookingAt(from, {0, 0, 0}, cosine / 8);
        const Film film = run.render(m.scene, camera, s).film;
        ReferenceBackend reference(m.scene, camera, s);
        const Totals found(film), right(render(reference, s, [&](const RenderProgress&) {
            run.goOn();
            return true;
        }));
        double share = std::max(std::abs(found.all.mean.x - 1) /
                                    (kAlbedoFits + kSigmasOfShares * found.error().x),
                                sigmasOff(found, right) / kSigmasOfShares);
        if (hasRejected(film)) share = std::numeric_limits<double>::infinity();
        if (!(share <= f.measured)) f.measured = share, f.where = fmt::format("cosine {}", cosine);
        f.trials += found.all.taken();
    }
    return f;
}

/// A ball of white glass in a ball of white glass, in light 1 from everywhere, and the same without
/// refraction (ior 1), but with absorption, along rays that pass at known distances from the
/// middle. A path knows the medium that it has entered last, and none behind its far side
/// (docs/theory/estimator.md, "Volumes").
Finding nestedGlass(Run& run) {
    constexpr double kOuter = 1, kInner = 0.5;
    const glm::dvec3 outerColor(0.7, 0.9, 0.5), innerColor(0.6, 0.3, 0.8);
    const auto nested = [&](float ior, bool absorbs) {
        SceneMaker m;
        Material glass = principled(0, 0);
        glass.principled.transmission = 1;
        glass.principled.isThin = false;
        glass.principled.ior = ior;
        if (absorbs) glass.principled.attenuationDistance = 1;
        for (const bool inner : {false, true}) {
            glass.principled.attenuationColor = glm::vec3(inner ? innerColor : outerColor);
            if (!absorbs) glass.principled.attenuationColor = glm::vec3(1);
            m.sphere({0, 0, 0}, float(inner ? kInner : kOuter), m.add(glass));
        }
        m.add(ambient(1));
        return m.scene;
    };
    Finding f;
    f.bound = 1;
    const auto check = [&](const Scene& scene, const Camera& camera, const glm::dvec3& expected,
                           const std::string& where) {
        const Totals found(run.render(scene, camera, picture(16, run.amount(8u, 512u), 200)).film);
        for (int c = 0; c < 3; ++c) {
            const double allowed = kAlbedoFits * expected[c] + kSigmasOfShares * found.error()[c];
            const double share = std::abs(found.all.mean[c] - expected[c]) / allowed;
            if (!(share <= f.measured)) f.measured = share, f.where = where;
        }
        f.trials += found.all.taken();
    };
    check(nested(1.5f, false), lookingAt({0, 0, 4}, {0, 0, 0}, 0.2), glm::dvec3(1), "furnace");
    const Scene absorbing = nested(1, true);
    const std::vector<double> distances =
        run.quick() ? std::vector<double>{0.3, 0.8} : std::vector<double>{0, 0.3, 0.45, 0.6, 0.8};
    for (const double b : distances) {
        const double half = std::sqrt(kOuter * kOuter - b * b);
        const double halfInner = b < kInner ? std::sqrt(kInner * kInner - b * b) : 0;
        const double outer = b < kInner ? half - halfInner : 2 * half;
        const glm::dvec3 expected = glm::pow(outerColor, glm::dvec3(outer)) *
                                    glm::pow(innerColor, glm::dvec3(2 * halfInner));
        Camera camera = lookingAt({b, 0, 4}, {b, 0, 0}, 1e-3);
        camera.orthographic = true;
        check(absorbing, camera, expected, fmt::format("chord {} from the middle", b));
    }
    return f;
}

/// Layers of opacity 1/4 in one plane, or each one float above the one before: paths and shadow
/// rays pass the share (3/4)^n. A stack for each number and kind, side by side, one a column of the
/// picture.
Finding alphaLayers(Run& run) {
    struct Stack {
        uint32_t layers;
        bool apart;
    };
    std::vector<Stack> stacks;
    for (const uint32_t layers : {0u, 1u, 2u, 3u, 5u, 8u, 13u, 32u})
        for (const bool apart : {false, true})
            stacks.push_back({layers, apart});
    const auto width = float(stacks.size());
    constexpr float kLowest = 0.25f; // of the layers
    Camera above = lookingAt({width / 2, 1, 0.5}, {width / 2, 0, 0.5}, width / 2);
    above.orthographic = true;
    above.right = {1, 0, 0}, above.up = {0, 0, -1};
    above.halfHeight = 0.5;
    Camera below = above;
    below.nearDistance = 1 - kLowest / 2; // between the layers and the floor
    Finding f;
    f.bound = 1;
    for (const bool byShadowRays : {false, true}) {
        SceneMaker m;
        m.quad({-1, 0, -1}, {0, 0, 3}, {width + 2, 0, 0},
               m.add(byShadowRays ? diffuse(0.5f) : emissive(1)));
        Material material = diffuse(0);
        material.alphaMode = AlphaMode::Blend;
        material.opacity = 0.25f;
        const uint32_t layer = m.add(material);
        for (size_t i = 0; i < stacks.size(); ++i) {
            float height = kLowest;
            for (uint32_t k = 0; k < stacks[i].layers; ++k) {
                m.quad({float(i), height, -1}, {0, 0, 3}, {1, 0, 0}, layer);
                if (stacks[i].apart) height = std::nextafter(height, 1.0f);
            }
        }
        Light sun;
        sun.kind = LightKind::Directional;
        sun.direction = {0, -1, 0};
        if (byShadowRays) m.add(sun);
        const RenderSettings s =
            picture(uint32_t(stacks.size()), byShadowRays ? 1 : run.amount(32u, 4096u), 1);
        const Film film = run.render(m.scene, byShadowRays ? below : above, s).film;
        for (uint32_t x = 0; x < stacks.size(); ++x) {
            const PixelStatistics all = columnOf(film, x);
            const double left = std::pow(0.75, stacks[x].layers);
            const double expected = byShadowRays ? 0.5 / M_PI * left : left;
            f.trials += all.taken();
            // Fewer paths than that have no nearly normal distribution.
            if (!byShadowRays && left * all.taken() < 25) continue;
            // The share of paths that get through is binomial; shadow rays have no randomness.
            const double error = byShadowRays ? 0 : std::sqrt(left * (1 - left) / all.taken());
            const double share =
                std::abs(all.mean.x - expected) / (kRounding * expected + kSigmasOfShares * error);
            if (!(share <= f.measured))
                f.measured = share,
                f.where = fmt::format("{} layers {}, {}", stacks[x].layers,
                                      stacks[x].apart ? "a float apart" : "in one plane",
                                      byShadowRays ? "shadow rays" : "paths");
        }
    }
    return f;
}

} // namespace

std::vector<Case> materialCases() {
    return {
        {"grazing-ggx", "69", "white metal of alpha 1e-4 at cosines to 1e-4 keeps the light",
         "share of limit", "samples", grazingGgx},
        {"alpha-layers", "70", "n layers of opacity a in one place let (1 - a)^n through",
         "share of limit", "samples", alphaLayers},
        {"nested-glass", "73", "white glass in white glass keeps the light; chords absorb",
         "share of limit", "samples", nestedGlass},
    };
}

} // namespace stromboli::stress

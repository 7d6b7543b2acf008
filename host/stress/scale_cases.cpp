// There is no length in the renderer: a scene of any size, its radiances unchanged, makes the same
// picture, and so does one that is not at the origin.
#include "host/check/cross_check.hpp"
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"
#include "host/stress/totals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::stress {
namespace {

/// Of all the comparisons of a case together.
constexpr double kFalseAlarms = 1e-3;

/// The worst of a comparison's three z-tests, relative to its limit.
double worst(const CheckResult& r) {
    double z = 0;
    for (const CheckChannel& c : r.channels)
        z = std::max(z, std::abs(c.z) / r.channelLimit);
    z = std::max(z, std::abs(r.worstBlock.z) / r.blockLimit);
    return r.agree() ? std::min(z, 1.0) : std::max(z, 1.0 + 1e-9);
}

/// Pictures of the Cornell box placed elsewhere against the one as it is, with other random
/// numbers.
template <class Place>
Finding compare(Run& run, const std::vector<float>& parameters, const RenderSettings& settings,
                const Place& place) {
    const Scene scene = cornellBox();
    const Camera camera = lookingAt({0.5, 0.5, 0.9375}, {0.5, 0.4375, 0}, 0.75);
    Finding f;
    f.bound = 1;
    std::vector<DirectLight> modes(std::begin(kDirectLightModes), std::end(kDirectLightModes));
    if (run.quick()) modes = {DirectLight::Mis};
    CheckSettings check;
    check.familyError = kFalseAlarms / double(parameters.size() * modes.size());
    RenderSettings s = settings;
    for (const DirectLight mode : modes) {
        s.estimator.directLight = mode;
        s.estimator.seed = 1;
        const Film before = run.render(scene, camera, s).film;
        for (const float parameter : parameters) {
            ++s.estimator.seed;
            const auto [otherScene, otherCamera] = place(scene, camera, parameter);
            const Film after = run.render(otherScene, otherCamera, s).film;
            const double found = worst(crossCheck(before, after, check));
            if (found > f.measured)
                f.measured = found, f.where = fmt::format("{:g}, {}", parameter, nameOf(mode));
            ++f.trials;
        }
    }
    return f;
}

Finding scales(Run& run) {
    const std::vector<float> factors =
        run.quick() ? std::vector<float>{1e-6f, 1e6f}
                    : std::vector<float>{1e-12f, 1e-6f, 1e-3f, 1e3f, 1e6f, 1e12f};
    return compare(run, factors, picture(run.amount(32u, 96u), run.amount(64u, 256u), 6),
                   [](const Scene& scene, const Camera& camera, float factor) {
                       return std::pair(placed(scene, factor), placed(camera, factor));
                   });
}

/// The coordinates of the box are such that it can be moved without rounding. The offsets of rays
/// grow with the distance (docs/numerics.md): at 1e4 of the box's size they are 3 % of it.
Finding translations(Run& run) {
    const std::vector<float> distances =
        run.quick() ? std::vector<float>{1024} : std::vector<float>{16, 256, 1024, 4096};
    return compare(run, distances, picture(run.amount(32u, 64u), run.amount(64u, 256u), 6),
                   [](const Scene& scene, const Camera& camera, float distance) {
                       const glm::vec3 by = distance * glm::vec3(1, -1, 1);
                       return std::pair(placed(scene, 1, by), placed(camera, 1, by));
                   });
}

} // namespace

std::vector<Case> scaleCases() {
    return {
        {"scales", "32", "the Cornell box scaled by 1e-12 to 1e12 makes the same picture",
         "z / limit", "pictures", scales},
        {"translations", "33", "the Cornell box moved far away makes the same picture", "z / limit",
         "pictures", translations},
    };
}

} // namespace stromboli::stress

#include "host/reference/reference_backend.hpp"
#include "tests/scene/mitsuba/references_renderer.hpp"

namespace stromboli::test {

const bool kCombinesLightSamplesWithBounces = false;

Film filmWith(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    ReferenceBackend backend(scene, camera, settings, 0);
    Film film(settings.area.width, settings.area.height);
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < film.pixels.size(); ++i)
        targets.push_back({i, settings.budget.mostSamplesPerPixel});
    backend.sample(targets, film, {});
    return film;
}

} // namespace stromboli::test

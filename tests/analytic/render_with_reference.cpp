#include "host/reference/reference_backend.hpp"
#include "tests/analytic/scenes.hpp"

namespace stromboli::test {

// pointCamera() sees more than a point: 1e-10 of the distance on each side.
const double kRounding = 1e-9;

const bool kCombinesLightSamplesWithBounces = false;

Film renderFilm(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                unsigned threads) {
    ReferenceBackend backend(scene, camera, settings, threads);
    Film film(settings.area.width, settings.area.height);
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < film.pixels.size(); ++i)
        targets.push_back({i, settings.budget.mostSamplesPerPixel});
    backend.sample(targets, film, {});
    return film;
}

std::vector<SampleValue> samplesAlone(const Scene& scene, const Camera& camera,
                                      const RenderSettings& settings, uint32_t pixel,
                                      uint32_t count) {
    ReferenceBackend backend(scene, camera, settings);
    std::vector<SampleValue> samples;
    for (uint32_t i = 0; i < count; ++i)
        samples.push_back(backend.sampleAlone(pixel, i));
    return samples;
}

RecordedPath recordedAlone(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           uint32_t pixel, uint32_t sample) {
    return ReferenceBackend(scene, camera, settings).record(pixel, sample);
}

std::vector<SeenPixel> seenBy(const Scene& scene, const Camera& camera,
                              const RenderSettings& settings, const std::vector<uint32_t>& samples,
                              Seeing what) {
    return ReferenceBackend(scene, camera, settings).see(0, samples, what);
}

glm::dvec3 meanInOrder(std::span<const SampleValue> samples) {
    PixelStatistics statistics;
    for (const SampleValue& s : samples)
        statistics.add(s.radiance);
    return statistics.mean;
}

} // namespace stromboli::test

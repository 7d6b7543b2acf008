#include "host/render/render.hpp"

#include "host/render/adaptive.hpp"

namespace stromboli {

std::vector<uint32_t> cropPixels(const RenderSettings& settings) {
    Crop c = settings.crop;
    if (c.width == 0) c = {0, 0, settings.width, settings.height};
    std::vector<uint32_t> pixels;
    pixels.reserve(size_t(c.width) * c.height);
    for (uint32_t y = 0; y < c.height; ++y)
        for (uint32_t x = 0; x < c.width; ++x)
            pixels.push_back((c.y + y) * settings.width + c.x + x);
    return pixels;
}

Film render(Backend& backend, const RenderSettings& settings, const ProgressCallback& progress) {
    Film film(settings.width, settings.height);
    const std::vector<uint32_t> pixels = cropPixels(settings);
    SamplingPlan plan(settings, pixels);
    RenderProgress state;
    state.samplesAtMost = uint64_t(pixels.size()) * settings.samplesPerPixel;
    bool goOn = true;
    while (goOn) {
        const std::vector<PixelTarget> pass = plan.next(film);
        if (pass.empty()) break;
        const uint64_t before = state.samplesDone;
        backend.sample(pass, film, [&](uint64_t done) {
            state.samplesDone = before + done;
            state.counters = backend.counters();
            if (progress) goOn = progress(state);
            return goOn;
        });
    }
    return film;
}

} // namespace stromboli

#include "host/render/render.hpp"

#include "host/core/stopwatch.hpp"
#include "host/render/adaptive.hpp"
#include "host/render/noise_estimate.hpp"
#include "host/render/noise_plan.hpp"

#include <algorithm>
#include <limits>

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

namespace {

/// What a render may still spend.
class TimeLimit {
  public:
    explicit TimeLimit(double seconds) : seconds_(seconds) {}
    bool over() const { return seconds_ > 0 && watch_.seconds() >= seconds_; }
    double shareUsed() const { return seconds_ > 0 ? watch_.seconds() / seconds_ : 0; }

    /// Samples that fit into the time left, at the rate so far; `first` while there is none.
    uint64_t samplesLeft(uint64_t done, uint64_t first) const {
        if (seconds_ == 0) return std::numeric_limits<uint64_t>::max();
        const double used = watch_.seconds();
        if (done == 0 || used == 0) return first;
        return uint64_t(std::max(seconds_ - used, 0.0) * double(done) / used);
    }

  private:
    double seconds_;
    Stopwatch watch_;
};

/// In all: if the noise is to fall from `reached`, where it is now, to `target`, as 1 / sqrt(n).
uint64_t expectedSamples(const RenderProgress& state, double reached, double target) {
    if (target == 0 || reached <= target) return state.samplesAtMost;
    const double ratio = reached / target;
    const double expected = double(state.samplesDone) * ratio * ratio;
    return expected < double(state.samplesAtMost) ? uint64_t(expected) + 1 : state.samplesAtMost;
}

} // namespace

Film render(Backend& backend, const RenderSettings& settings, const ProgressCallback& progress,
            RenderOutcome* outcome) {
    Film film(settings.width, settings.height);
    const std::vector<uint32_t> pixels = cropPixels(settings);
    SamplingPlan plan(settings, pixels);
    const NoisePlan noisePlan(pixels, settings.samplesPerPixel);
    NoiseEstimate estimate(pixels);
    const TimeLimit time(settings.stop.seconds);
    RenderProgress state;
    state.samplesAtMost = uint64_t(pixels.size()) * settings.samplesPerPixel;

    const auto nextPass = [&] {
        if (!settings.stop.given()) return plan.next(film);
        const uint64_t budget = time.samplesLeft(state.samplesDone, pixels.size());
        return noisePlan.next(film, estimate, budget, settings.stop.noise);
    };
    double noise = 0;
    bool goOn = true;
    while (goOn && !time.over()) {
        const std::vector<PixelTarget> pass = nextPass();
        if (pass.empty()) break;
        const uint64_t before = state.samplesDone;
        const uint64_t atMost = expectedSamples(state, noise, settings.stop.noise);
        backend.sample(pass, film, [&](uint64_t done) {
            state.samplesDone = before + done;
            state.counters = backend.counters();
            state.share = std::max(time.shareUsed(), double(state.samplesDone) / double(atMost));
            if (progress) goOn = progress(state);
            return goOn && !time.over();
        });
        estimate.update(film);
        noise = estimate.picture(film);
    }
    if (outcome) *outcome = {noise, time.over()};
    return film;
}

} // namespace stromboli

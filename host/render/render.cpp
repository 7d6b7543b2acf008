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

uint64_t samplesAtMost(const RenderSettings& settings) {
    const Crop& c = settings.crop;
    const uint64_t pixels =
        c.width == 0 ? uint64_t(settings.width) * settings.height : uint64_t(c.width) * c.height;
    const StopRule& stop = settings.stop;
    return pixels * (stop.meanSamples > 0 ? std::min(stop.meanSamples, settings.samplesPerPixel)
                                          : settings.samplesPerPixel);
}

namespace {

/// What a render may still spend.
class Limit {
  public:
    Limit(const StopRule& stop, uint64_t pixels)
        : seconds_(stop.seconds), pixels_(pixels),
          samples_(stop.meanSamples > 0 ? pixels * stop.meanSamples
                                        : std::numeric_limits<uint64_t>::max()) {}
    bool timeIsOver() const { return seconds_ > 0 && watch_.seconds() >= seconds_; }
    double shareOfTimeUsed() const { return seconds_ > 0 ? watch_.seconds() / seconds_ : 0; }

    /// Samples that fit, as to time at the rate so far, or one a pixel while there is none.
    uint64_t samplesLeft(uint64_t done) const {
        const uint64_t left = samples_ - std::min(done, samples_);
        if (seconds_ == 0) return left;
        const double used = watch_.seconds();
        if (done == 0 || used == 0) return std::min(left, pixels_);
        return std::min(left, uint64_t(std::max(seconds_ - used, 0.0) * double(done) / used));
    }

  private:
    double seconds_;
    uint64_t pixels_, samples_;
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
    film.branches = settings.branches;
    const std::vector<uint32_t> pixels = cropPixels(settings);
    SamplingPlan plan(settings, pixels);
    const NoisePlan noisePlan(pixels, settings.samplesPerPixel, settings.branches);
    NoiseEstimate estimate(pixels);
    const Limit limit(settings.stop, pixels.size());
    RenderProgress state;
    state.samplesAtMost = samplesAtMost(settings);

    const auto nextPass = [&] {
        if (!settings.stop.spreads()) return plan.next(film);
        return noisePlan.next(film, estimate, limit.samplesLeft(state.samplesDone),
                              settings.stop.noise);
    };
    double noise = 0;
    bool goOn = true;
    while (goOn && !limit.timeIsOver()) {
        const std::vector<PixelTarget> pass = nextPass();
        if (pass.empty()) break;
        const uint64_t before = state.samplesDone;
        const uint64_t atMost = expectedSamples(state, noise, settings.stop.noise);
        backend.sample(pass, film, [&](uint64_t done) {
            state.samplesDone = before + done;
            state.counters = backend.counters();
            state.share =
                std::max(limit.shareOfTimeUsed(), double(state.samplesDone) / double(atMost));
            if (progress) goOn = progress(state);
            return goOn && !limit.timeIsOver();
        });
        estimate.update(film);
        noise = estimate.picture(film);
    }
    if (outcome) *outcome = {noise, limit.timeIsOver()};
    return film;
}

} // namespace stromboli

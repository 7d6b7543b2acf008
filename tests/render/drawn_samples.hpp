#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/picture_noise.hpp"
#include "host/render/sampling_session.hpp"

#include <cmath>
#include <functional>
#include <random>

namespace stromboli::test {

/// Side of the pictures, in pixels.
inline constexpr uint32_t kSide = 48;

/// SplitMix64 (Steele, Lea and Flood 2014): a generator that is cheap to start, for each sample has
/// its own.
struct Random {
    using result_type = uint64_t;
    uint64_t state;
    static constexpr uint64_t min() { return 0; }
    static constexpr uint64_t max() { return ~uint64_t(0); }
    uint64_t operator()() {
        uint64_t z = state += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
};

/// Draws one sample of a pixel.
using Draw = std::function<double(uint32_t pixel, Random& random)>;

/// Draws numbers of known mean and variance: samples without a renderer.
class DrawnBackend : public Backend {
  public:
    DrawnBackend(Draw draw, uint32_t seed) : draw_(std::move(draw)), seed_(seed) {}

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override {
        uint64_t done = 0;
        for (const PixelTarget& t : targets)
            while (film.pixels[t.pixel].taken() < t.samples) {
                film.pixels[t.pixel].add(
                    sampleAlone(t.pixel, first_ + film.pixels[t.pixel].taken()).radiance);
                if (++done % 4096 == 0 && !progress(done)) return;
            }
        progress(done);
    }
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override {
        Random random{seed_ * 0x9E3779B97F4A7C15u ^ (uint64_t(pixel) << 32 | sample)};
        random.state = random();
        return {glm::dvec3(draw_(pixel, random))};
    }
    RenderCounters counters() const override { return {}; }
    void beginAt(uint32_t firstSample) override { first_ = firstSample; }

  private:
    uint32_t first_ = 0;
    Draw draw_;
    uint32_t seed_;
};

/// Gamma-distributed with mean 1 and this relative sigma.
inline double gamma(double sigma, Random& random) {
    return std::gamma_distribution<double>(1 / (sigma * sigma), sigma * sigma)(random);
}

inline RenderSettings settingsOf(uint32_t samples) {
    RenderSettings s;
    s.area.width = s.area.height = kSide;
    s.budget.mostSamplesPerPixel = samples;
    return s;
}

/// relMSE against a picture that is 1 everywhere.
inline double trueRelativeError(const Film& film) {
    double sum = 0;
    for (const PixelStatistics& p : film.pixels)
        sum += (p.mean.x - 1) * (p.mean.x - 1);
    return sum / double(film.pixels.size()) / (1 + kRelativeFloor * kRelativeFloor);
}

inline uint64_t samplesOf(const Film& film) {
    uint64_t sum = 0;
    for (const PixelStatistics& p : film.pixels)
        sum += p.taken();
    return sum;
}

struct Rendered {
    Film film;
    RenderOutcome outcome;
};

inline Rendered renderDrawn(const Draw& draw, const RenderSettings& s, uint32_t seed) {
    DrawnBackend backend(draw, seed);
    Rendered r;
    r.film = render(backend, s, {}, &r.outcome);
    return r;
}

/// Every tenth pixel's sigma is 20 times the others'.
inline double uneven(uint32_t pixel, Random& random) {
    const bool noisy = pixel % kSide / 5 == 3;
    return gamma(noisy ? 4.0 : 0.2, random);
}

inline double even(uint32_t, Random& random) {
    return gamma(0.7, random);
}

} // namespace stromboli::test

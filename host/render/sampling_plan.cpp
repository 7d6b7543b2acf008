#include "host/render/sampling_plan.hpp"

#include "host/core/color.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

namespace stromboli {
namespace {

/// 97.5 % quantile of the normal distribution: half width of a 95 % interval in sigmas.
constexpr double k95 = 1.96;

/// Adaptive::Rule::PerChannel: each channel's 95 % interval within tolerance times its mean. A
/// pixel whose samples are all black passes at once.
bool everyChannelIsDone(const PixelStatistics& p, double tolerance) {
    const glm::dvec3 variance = p.varianceOfMean();
    for (int c = 0; c < 3; ++c)
        if (k95 * std::sqrt(variance[c]) > tolerance * std::abs(p.mean[c])) return false;
    return true;
}

/// Statistics over a pixel and its neighbours, so that a pixel that has not met the light yet
/// is judged by those that have.
struct Neighbourhood {
    double mean = 0;     ///< luminance
    double variance = 0; ///< of one sample, luminance bound: channels fully correlated
};

/// Variance of the luminance, bounded above: sigma of a weighted sum is at most the weighted sum
/// of sigmas.
double luminanceVariance(const glm::dvec3& variance) {
    const double sigma = luminance(glm::sqrt(variance));
    return sigma * sigma;
}

} // namespace

std::vector<PixelTarget> SamplingPlan::next(const Film& film) const {
    return budget_.adaptive.enabled ? adaptive(film) : uniform(film);
}

std::vector<PixelTarget> SamplingPlan::uniform(const Film& film) const {
    uint32_t least = budget_.mostSamplesPerPixel;
    for (const PixelStatistics& p : film.pixels)
        least = std::min(least, p.taken());
    // The largest power of two below the end: what the last pass changes says how large the noise
    // is that is left (picture_noise.hpp). A few samples, of which the variance says as much, are
    // not worth a pass more.
    const uint64_t lastButOne = budget_.mostSamplesPerPixel < kFirstPass
                                    ? 0
                                    : std::bit_floor(budget_.mostSamplesPerPixel - 1);
    const uint64_t usual = least == 0 ? kFirstPass : uint64_t(least) * 4;
    const auto samples =
        uint32_t(least < lastButOne ? std::min(usual, lastButOne) : budget_.mostSamplesPerPixel);
    std::vector<PixelTarget> pass;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel)
        if (film.pixels[pixel].taken() < samples) pass.push_back({pixel, samples});
    return pass;
}

std::vector<PixelTarget> SamplingPlan::adaptive(const Film& film) const {
    const bool perChannel = budget_.adaptive.rule == Adaptive::Rule::PerChannel;
    const std::vector<bool> wanted =
        perChannel ? unfinishedPerChannel(film) : unfinishedByNeighbourhood(film);
    std::vector<PixelTarget> pass;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const uint32_t taken = film.pixels[pixel].taken();
        if (!wanted[pixel] || taken >= budget_.mostSamplesPerPixel) continue;
        const uint32_t batch = budget_.adaptive.batch;
        const uint32_t first =
            perChannel ? batch : std::max(batch, kMinimumSamples); // before the first test
        const uint64_t target = taken == 0 ? first : uint64_t(taken) + batch;
        pass.push_back({pixel, uint32_t(std::min<uint64_t>(target, budget_.mostSamplesPerPixel))});
    }
    return pass;
}

std::vector<bool> SamplingPlan::unfinishedPerChannel(const Film& film) const {
    std::vector<bool> wanted(film.pixels.size(), false);
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const PixelStatistics& p = film.pixels[pixel];
        wanted[pixel] = p.taken() == 0 || !everyChannelIsDone(p, budget_.adaptive.tolerance);
    }
    return wanted;
}

double SamplingPlan::pictureMean(const Film& film) const {
    double sum = 0;
    for (const PixelStatistics& p : film.pixels)
        sum += luminance(p.mean);
    return film.pixels.empty() ? 0 : sum / double(film.pixels.size());
}

std::vector<bool> SamplingPlan::unfinishedByNeighbourhood(const Film& film) const {
    const double floor = kFloor * pictureMean(film);
    const auto at = [&](int64_t x, int64_t y) -> const PixelStatistics* {
        if (x < 0 || y < 0 || x >= film.width || y >= film.height) return nullptr;
        const PixelStatistics& p = film.at(uint32_t(x), uint32_t(y));
        return p.taken() > 0 ? &p : nullptr;
    };
    const auto neighbourhood = [&](int64_t x, int64_t y) {
        Neighbourhood n;
        int count = 0;
        for (int64_t dy = -1; dy <= 1; ++dy)
            for (int64_t dx = -1; dx <= 1; ++dx)
                if (const PixelStatistics* p = at(x + dx, y + dy)) {
                    n.mean += luminance(p->mean);
                    n.variance += luminanceVariance(p->variance());
                    ++count;
                }
        if (count > 0) n.mean /= count, n.variance /= count;
        return n;
    };
    std::vector<bool> noisy(film.pixels.size(), false);
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const PixelStatistics& p = film.pixels[pixel];
        if (p.taken() == 0) {
            noisy[pixel] = true;
            continue;
        }
        const Neighbourhood n = neighbourhood(pixel % film.width, pixel / film.width);
        const double variance = std::max(luminanceVariance(p.variance()), n.variance);
        const double level = std::max(std::min(luminance(p.mean), n.mean), floor);
        const double error = k95 * std::sqrt(variance / std::max(p.count, 1u));
        noisy[pixel] = error > budget_.adaptive.tolerance * level;
    }
    return dilate(noisy, film);
}

/// A pixel goes on while one of its eight neighbours does.
std::vector<bool> SamplingPlan::dilate(const std::vector<bool>& noisy, const Film& film) const {
    std::vector<bool> wanted(noisy.size(), false);
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const int64_t x = pixel % film.width, y = pixel / film.width;
        for (int64_t ny = std::max<int64_t>(y - 1, 0);
             ny <= std::min<int64_t>(y + 1, film.height - 1); ++ny)
            for (int64_t nx = std::max<int64_t>(x - 1, 0);
                 nx <= std::min<int64_t>(x + 1, film.width - 1); ++nx)
                if (noisy[size_t(ny * film.width + nx)]) wanted[pixel] = true;
    }
    return wanted;
}

namespace {

/// A pass that adds a smaller share than this to the samples is not worth its start: the noise
/// falls by half of it.
constexpr uint64_t kLeastPassShare = 64;

/// The rung above n: 4, 6, 8, 12, 16, ...
uint32_t nextRung(uint32_t n) {
    const uint32_t power = std::bit_floor(n);
    return n < power + power / 2 ? power + power / 2 : 2 * power;
}

/// One rung for one pixel, and what it is worth: less for each further rung of the same pixel.
struct Step {
    uint32_t pixel;
    uint32_t target;
    uint32_t cost; ///< samples
    double worth;  ///< fall of the picture's squared error per sample
};

/// The most worth steps of `steps` that fit into the budget, in any order: selection by halves
/// instead of sorting. Of equal worth, the first in the picture: the same film always gives the
/// same pass.
std::span<const Step> mostWorth(std::vector<Step>& steps, uint64_t budget) {
    const auto before = [](const Step& a, const Step& b) {
        return std::tie(b.worth, a.pixel, a.target) < std::tie(a.worth, b.pixel, b.target);
    };
    auto taken = steps.begin(), end = steps.end();
    while (taken != end) {
        const auto half = taken + (end - taken) / 2;
        std::nth_element(taken, half, end, before); // *half is in its place
        uint64_t cost = 0;
        for (auto step = taken; step <= half; ++step)
            cost += step->cost;
        if (cost > budget) {
            end = half;
        } else {
            budget -= cost;
            taken = half + 1;
        }
    }
    return {steps.begin(), taken};
}

/// Rungs a pixel may climb in one pass: four times the samples. Variances of a few samples are
/// rough.
constexpr int kMostRungs = 4;

uint64_t samplesOf(const Film& film) {
    uint64_t sum = 0;
    for (const PixelStatistics& p : film.pixels)
        sum += p.taken();
    return sum;
}

/// A black picture is believed to be black when a light that one sample in a million meets would
/// have been seen in 95 of 100 renders (rule of three).
constexpr uint64_t kBlackSamples = 3'000'000;

/// Whether the picture's noise is at most `noise`, in 95 of 100 renders.
bool isEnough(const PictureNoise& reached, double noise, uint64_t samples) {
    if (reached.unknown == PictureNoise::Unknown::Black) return samples >= kBlackSamples;
    return reached.known() && reached.most <= noise;
}

} // namespace

/// Steps, targets by pixel, and the pass.
const uint64_t NoisePlan::kBytesPerPixel =
    kMostRungs * sizeof(Step) + sizeof(uint32_t) + sizeof(PixelTarget);

NoisePlan::NoisePlan(uint32_t mostSamples, uint32_t branches, Beginning beginning)
    : mostSamples_(mostSamples),
      firstSamples_(std::max(kFirstPaths / branches, kLeastFirstSamples)), beginning_(beginning) {}

/// One sample for the pixels of the coarsest grid that has some without.
std::vector<PixelTarget> NoisePlan::cover(const Film& film) const {
    std::vector<PixelTarget> pass;
    for (uint32_t step = kCoarsest; pass.empty() && step > 0; step /= 2)
        for (uint32_t y = 0; y < film.height; y += step)
            for (uint32_t x = 0; x < film.width; x += step)
                if (film.at(x, y).taken() == 0) pass.push_back({y * film.width + x, 1});
    return pass;
}

/// Brings all pixels to firstSamples_, or to the power of two that the budget allows.
std::vector<PixelTarget> NoisePlan::raiseAll(const Film& film, uint64_t budget) const {
    const uint64_t goal = std::min(firstSamples_, mostSamples_);
    uint64_t least = goal;
    for (const PixelStatistics& p : film.pixels)
        least = std::min<uint64_t>(least, p.taken());
    const uint64_t more = budget / film.pixels.size(); // any number: budgets need have no end
    const uint64_t samples = more >= goal - least ? goal : std::bit_floor(least + more);
    std::vector<PixelTarget> pass;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel)
        if (film.pixels[pixel].taken() < samples) pass.push_back({pixel, uint32_t(samples)});
    return samples > least ? pass : std::vector<PixelTarget>{};
}

namespace {

/// How many times the error of even samples is that of samples which go where they help most, if
/// each has these variances: counts in proportion to their roots (Cauchy and Schwarz). 1 where all
/// are alike.
double gainOfSpreading(const std::vector<double>& variances) {
    double sum = 0, roots = 0;
    for (const double variance : variances) {
        sum += variance;
        roots += std::sqrt(variance);
    }
    return roots > 0 ? sum * double(variances.size()) / (roots * roots) : 1;
}

bool isEven(const Film& film) {
    return std::ranges::all_of(film.pixels, [&](const PixelStatistics& p) {
        return p.taken() == film.pixels.front().taken();
    });
}

std::vector<PixelTarget> allTo(uint32_t samples, const Film& film) {
    std::vector<PixelTarget> pass;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel)
        pass.push_back({pixel, samples});
    return pass;
}

} // namespace

std::vector<PixelTarget> NoisePlan::spread(const Film& film, const std::vector<double>& variance,
                                           uint64_t budget) const {
    const double least =
        kLeastShare * double(samplesOf(film) + budget) / double(film.pixels.size());
    std::vector<Step> steps;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        uint32_t n = film.pixels[pixel].taken();
        for (int rung = 0; rung < kMostRungs && n < mostSamples_; ++rung) {
            const uint32_t target = std::min(nextRung(n), mostSamples_);
            const double worth = n < least ? std::numeric_limits<double>::infinity()
                                           : variance[pixel] / (double(n) * double(target));
            steps.push_back({pixel, target, target - n, worth});
            n = target;
        }
    }
    std::vector<uint32_t> target(film.pixels.size(), 0);
    for (const Step& step : mostWorth(steps, budget))
        target[step.pixel] = std::max(target[step.pixel], step.target);
    std::vector<PixelTarget> pass;
    for (uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel)
        if (target[pixel] > 0) pass.push_back({pixel, target[pixel]});
    return pass;
}

std::vector<PixelTarget> NoisePlan::next(const Film& film, const NoiseEstimate& estimate,
                                         uint64_t budget, double noise) const {
    if (film.pixels.empty()) return {};
    const uint32_t fewest =
        std::ranges::min_element(film.pixels, {}, &PixelStatistics::taken)->taken();
    if (fewest < std::min(firstSamples_, mostSamples_)) {
        if (beginning_ == Beginning::AllAlike) return raiseAll(film, budget);
        // However many there are: the time ends the pass, not the plan.
        return fewest == 0 ? cover(film) : raiseAll(film, film.pixels.size() * uint64_t(fewest));
    }
    const PictureNoise reached = noise > 0 ? estimate.picture(film) : PictureNoise{};
    if (noise > 0 && isEnough(reached, noise, samplesOf(film))) return {};

    const uint64_t taken = samplesOf(film);
    if (budget < taken / kLeastPassShare) return {};
    uint64_t wanted = taken; // a pass has its costs whatever its size
    if (reached
            .known()) { // what is missing if errors fall as slowly as those of independent samples
        const double ratio = reached.most / noise;
        const double missing = double(taken) * (ratio * ratio - 1);
        if (missing < double(wanted)) wanted = uint64_t(missing);
    }
    std::vector<double> variance = estimate.relativeVariance(film);
    if (std::ranges::max(variance) == 0)
        std::ranges::fill(variance, 1.0); // nothing known: all alike
    const uint64_t size = std::min(budget, std::max(wanted, taken / kLeastPassShare + 1));
    const uint64_t evenly = std::min<uint64_t>(fewest + size / film.pixels.size(), mostSamples_);
    if (evenly > fewest && isEven(film) && gainOfSpreading(variance) < kLeastGain)
        return allTo(uint32_t(evenly), film);
    return spread(film, variance, size);
}

} // namespace stromboli

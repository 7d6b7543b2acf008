#include "host/render/picture_noise.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace stromboli {

namespace {

/// Side of the tiles, in pixels, whose means stand between those of the picture and of a window: a
/// thousand pixels meet a light of probability 1/2000 once in two samples.
constexpr uint32_t kTile = 32;
/// Rows a thread takes at a time, and whose sums are added first: the result does not depend on the
/// number of threads.
constexpr uint32_t kBand = 64;

/// Mean and squared error of the mean, per channel, of some pixels that stand for another.
struct Level {
    glm::dvec3 mean{0.0}, squaredError{0.0};
};

Level levelOf(const PixelGroup& group) {
    return {group.mean / group.pixels, group.value / group.pixels};
}

PixelGroup without(const PixelGroup& all, const PixelGroup& one) {
    return {glm::max(all.value - one.value, 0.0), glm::max(all.mean - one.mean, 0.0),
            all.pixels - one.pixels};
}

/// What is to be believed of two estimates, a finer one and a coarser one: the finer as far as the
/// two differ by more than its own error explains (James and Stein 1961, one channel at a time).
/// The error is the larger of what either level says: a window that has not met a rare light looks
/// certain of being black, which its surroundings know better.
Level shrink(const Level& finer, double pixels, const Level& coarser) {
    Level result;
    for (int c = 0; c < 3; ++c) {
        const double variance = std::max(finer.squaredError[c], coarser.squaredError[c]) / pixels;
        const double apart = finer.mean[c] - coarser.mean[c];
        const double real = std::max(apart * apart - variance, 0.0);
        const double trust = real + variance > 0 ? real / (real + variance) : 0;
        result.mean[c] = coarser.mean[c] + trust * apart;
        result.squaredError[c] =
            coarser.squaredError[c] + trust * (finer.squaredError[c] - coarser.squaredError[c]);
    }
    return result;
}

/// The radiance that a pixel's error is compared with, by groups that get smaller, and `own` at
/// last. Groups without pixels are passed over.
glm::dvec3 believed(std::initializer_list<PixelGroup> coarseToFine, const PixelGroup& own) {
    Level level = levelOf(own);
    bool first = true;
    for (const PixelGroup& group : coarseToFine) {
        if (group.pixels == 0) continue;
        level = first ? levelOf(group) : shrink(levelOf(group), group.pixels, level);
        first = false;
    }
    return first ? level.mean : shrink(levelOf(own), 1, level).mean;
}

double relative(const glm::dvec3& squaredError, const glm::dvec3& radiance, double floor) {
    const glm::dvec3 r = squaredError / (radiance * radiance + floor * floor);
    return (r.x + r.y + r.z) / 3;
}

/// How many standard errors a pixel's radiance may lie below what its samples say, beside darker
/// ones. A pixel of which the part f is a lamp, that one of n samples has met, has a mean of 1 / n
/// of the lamp and the same standard error; before anything is known of f, its density is then n^2
/// f exp(-n f), so that of ten such pixels one has f < 0.1 / n in five pictures of a hundred.
constexpr double kDarkest = 0.9;

/// Sums over pixels of their relative squared errors x: compared with what the others say, without
/// the pixel itself (`apart`) and with it. An error that is one bright sample is too large in the
/// former, where its neighbours have met none, and too small in the latter, which it brightens.
/// Beside an edge both believe that a pixel which has met the bright side is bright. `likeAny`
/// takes it to be like any of its neighbours: where a lamp reaches into a pixel by a little, few
/// samples meet it, and one that does makes the largest error of the picture.
struct Errors {
    struct Pixel {
        double apart = 0, together = 0;
        double product() const { return apart * together; }
    };
    double apart = 0, apartSquared = 0, together = 0, likeAny = 0;
    double samples = 0, pixels = 0;
    std::vector<Pixel> worst; ///< at most kWorstPixels, the worst first

    void keepIfAmongWorst(const Pixel& p) {
        const auto place =
            std::ranges::upper_bound(worst, p.product(), std::greater(), &Pixel::product);
        worst.insert(place, p);
        if (worst.size() > kWorstPixels) worst.pop_back();
    }

    /// That so many have in the square of the picture's noise, the geometric mean of both.
    double shareOfWorst(uint64_t count) const {
        Pixel sum;
        for (const Pixel& p : std::span(worst).first(count))
            sum = {sum.apart + p.apart, sum.together + p.together};
        return apart * together > 0 ? std::sqrt(sum.product() / (apart * together)) : 0;
    }
};

class Picture {
  public:
    Picture(const Film& film, std::span<const glm::dvec3> squaredErrors)
        : film_(film), squaredErrors_(squaredErrors),
          tilesAcross_((film.width + kTile - 1) / kTile),
          tiles_(size_t(tilesAcross_) * ((film.height + kTile - 1) / kTile)),
          weights_(film.pixels.size(), glm::vec3(0.0f)) {
        for (uint32_t y = 0; y < film.height; ++y)
            for (uint32_t x = 0; x < film.width; ++x) {
                const size_t i = size_t(y) * film.width + x;
                if (film.pixels[i].count >= 2)
                    tiles_[tileOf(x, y)] += {squaredErrors[i], film.pixels[i].mean, 1};
            }
        for (const PixelGroup& tile : tiles_)
            all_ += tile;
    }

    double meanRadiance() const {
        return all_.pixels > 0 ? (all_.mean.x + all_.mean.y + all_.mean.z) / (3 * all_.pixels) : 0;
    }

    Errors errors() {
        std::vector<Errors> bands((film_.height + kBand - 1) / kBand);
        const auto inBands = [&](auto&& add) {
            tbb::parallel_for(size_t(0), bands.size(), [&](size_t band) {
                const auto first = uint32_t(band) * kBand;
                add(bands[band], first, std::min(first + kBand, film_.height));
            });
        };
        inBands([&](Errors& e, uint32_t first, uint32_t end) { addRows(e, first, end); });
        inBands([&](Errors& e, uint32_t first, uint32_t end) { addLikeAny(e, first, end); });
        Errors sum;
        for (const Errors& e : bands) {
            sum.apart += e.apart, sum.apartSquared += e.apartSquared, sum.together += e.together;
            sum.likeAny += e.likeAny;
            sum.samples += e.samples, sum.pixels += e.pixels;
            for (const Errors::Pixel& pixel : e.worst)
                sum.keepIfAmongWorst(pixel);
        }
        return sum;
    }

  private:
    size_t tileOf(uint32_t x, uint32_t y) const {
        return size_t(y / kTile) * tilesAcross_ + x / kTile;
    }

    void addRows(Errors& sum, uint32_t first, uint32_t end) {
        const double floor = kRelativeFloor * meanRadiance();
        PixelWindows windows(film_, squaredErrors_, first);
        for (uint32_t y = first; y < end; ++y) {
            const std::vector<PixelGroup> row = windows.of(y);
            for (uint32_t x = 0; x < film_.width; ++x) {
                const PixelGroup own = windows.alone(x, y);
                if (own.pixels == 0) continue;
                sum.samples += film_.at(x, y).count;
                ++sum.pixels;
                const PixelGroup& tile = tiles_[tileOf(x, y)];
                PixelGroup window = row[x];
                // What the last pass changed is the error's size on the mean over pixels; in one
                // pixel it may be next to nothing, where the samples' variance is not. For the
                // upper end of the range the larger of the two says how far to believe the pixel.
                PixelGroup careful = own;
                careful.value = glm::max(own.value, film_.at(x, y).varianceOfMean());
                const double apart = relative(
                    own.value, believed({without(all_, own), without(tile, own), window}, careful),
                    floor);
                window += own;
                const glm::dvec3 radiance = believed({all_, tile, window}, own);
                weights_[size_t(y) * film_.width + x] =
                    glm::vec3(1.0 / (radiance * radiance + floor * floor));
                const double together = relative(own.value, radiance, floor);
                sum.apart += apart, sum.apartSquared += apart * apart;
                sum.together += together;
                sum.keepIfAmongWorst({apart, together});
            }
        }
    }

    void addLikeAny(Errors& sum, uint32_t first, uint32_t end) const {
        const double floor = kRelativeFloor * meanRadiance();
        for (uint32_t y = first; y < end; ++y)
            for (uint32_t x = 0; x < film_.width; ++x) {
                const size_t i = size_t(y) * film_.width + x;
                const PixelStatistics& own = film_.pixels[i];
                if (own.count < 2 || squaredErrors_[i] == glm::dvec3(0.0)) continue;
                const glm::dvec3 darkest =
                    glm::max(own.mean - kDarkest * glm::sqrt(own.varianceOfMean()), 0.0);
                const glm::vec3 most(1.0 / (darkest * darkest + floor * floor));
                const glm::dvec3 r = squaredErrors_[i] * glm::dvec3(weightAround(x, y, most));
                sum.likeAny += (r.x + r.y + r.z) / 3;
            }
    }

    /// Mean weight of the pixel and its neighbours, each `most` at most.
    glm::vec3 weightAround(uint32_t x, uint32_t y, const glm::vec3& most) const {
        glm::vec3 sum(0.0f);
        float pixels = 0;
        for (uint32_t v = y > 0 ? y - 1 : 0; v < std::min(y + 2, film_.height); ++v)
            for (uint32_t u = x > 0 ? x - 1 : 0; u < std::min(x + 2, film_.width); ++u) {
                const glm::vec3& weight = weights_[size_t(v) * film_.width + u];
                sum += glm::min(weight, most);
                pixels += weight.x > 0;
            }
        return sum / pixels;
    }

    const Film& film_;
    std::span<const glm::dvec3> squaredErrors_;
    uint32_t tilesAcross_;
    std::vector<PixelGroup> tiles_;
    PixelGroup all_;
    /// What squared errors are multiplied by for the radiance that is believed, by pixel; 0: no
    /// samples.
    std::vector<glm::vec3> weights_;
};

constexpr double kZ = 1.96; ///< 97.5 % of the normal distribution
/// The fewest pixels at work for which a chi-square distribution stands for anything.
constexpr double kLeastPixels = 3;

/// What the estimate of the relMSE may be off by besides chance. Measured on the bundled scenes at
/// 2 to 64 samples (docs/results.md): edges and highlights, where the radiance around a pixel is
/// not its own, make it up to 1.4 times too small, and more with a few samples, which meet the
/// narrow side of an edge or do not: 2.1 times with four.
double tooSmall(double samplesPerPixel) {
    return 1.4 * (1 + 2 / samplesPerPixel);
}
/// Too large up to 3.7 times where Sobol points fill each other's gaps (the error of half the
/// samples, which is what the last pass changed, is then nearly all there was), and where light is
/// so rare that most pixels around one that has met it have not.
constexpr double kTooLarge = 4;

} // namespace

double chiSquareQuantile(double degrees, double z) {
    const double spread = 2 / (9 * degrees);
    const double root = 1 - spread + z * std::sqrt(spread);
    return degrees * root * root * root;
}

PictureNoise pictureNoise(const Film& film, std::span<const glm::dvec3> squaredErrors) {
    using Unknown = PictureNoise::Unknown;
    const bool sampled = std::all_of(film.pixels.begin(), film.pixels.end(),
                                     [](const PixelStatistics& p) { return p.taken() >= 2; });
    if (!sampled) return {Unknown::TooFewSamples};
    Picture picture(film, squaredErrors);
    if (!(picture.meanRadiance() > 0)) return {Unknown::Black};
    const Errors errors = picture.errors();
    if (errors.apart == 0) return {Unknown::No}; // every sample of a pixel is the same
    // The number of pixels of equal errors that would vary as much. Both the estimate and the noise
    // it is to hold vary so: half as many degrees of freedom as the estimate alone has.
    const double pixels = errors.apart * errors.apart / errors.apartSquared;
    if (pixels < kLeastPixels) return {Unknown::TooFewPixels};
    const double apart = errors.apart / errors.pixels, together = errors.together / errors.pixels;
    const double likeAny = errors.likeAny / errors.pixels;
    PictureNoise noise{Unknown::No};
    noise.estimate = std::sqrt(std::sqrt(apart * together));
    noise.least =
        std::sqrt(std::min(apart, together) * pixels / (chiSquareQuantile(pixels, kZ) * kTooLarge));
    noise.most =
        std::sqrt(std::max({apart, together, likeAny}) * pixels *
                  tooSmall(errors.samples / errors.pixels) / chiSquareQuantile(pixels, -kZ));
    noise.worstPixels = std::min(errors.worst.size(), size_t(errors.pixels / 100));
    noise.ofWorst = errors.shareOfWorst(noise.worstPixels);
    return noise;
}

PictureNoise togetherOf(std::span<const PartNoise> parts) {
    using Unknown = PictureNoise::Unknown;
    if (parts.size() == 1) return parts[0].noise;
    PictureNoise sum{Unknown::Black};
    double pixels = 0;
    for (const auto& [noise, count] : parts) {
        pixels += double(count);
        if (noise.unknown == Unknown::Black) continue;
        if (!noise.known()) return {noise.unknown};
        sum.unknown = Unknown::No;
        sum.estimate += noise.estimate * noise.estimate * double(count);
        sum.least += noise.least * noise.least * double(count);
        sum.most += noise.most * noise.most * double(count);
        sum.ofWorst += noise.ofWorst * noise.estimate * noise.estimate * double(count);
        sum.worstPixels += noise.worstPixels;
    }
    if (!sum.known()) return sum;
    return {Unknown::No,
            std::sqrt(sum.estimate / pixels),
            std::sqrt(sum.least / pixels),
            std::sqrt(sum.most / pixels),
            sum.estimate > 0 ? sum.ofWorst / sum.estimate : 0,
            sum.worstPixels};
}

namespace {

double meanOfChannels(const glm::dvec3& v) {
    return (v.x + v.y + v.z) / 3;
}

} // namespace

void NoiseEstimate::update(const Film& film) {
    const size_t pixels = film.pixels.size();
    memory_.counts.resize(pixels, 0);
    memory_.means.resize(pixels, glm::dvec3(0.0));
    memory_.squaredErrors.resize(pixels, glm::dvec3(0.0));
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelStatistics& p = film.pixels[i];
        if (p.count == memory_.counts[i]) continue;
        const glm::dvec3 moved = p.mean - memory_.means[i];
        memory_.squaredErrors[i] =
            memory_.counts[i] == 0
                ? p.varianceOfMean()
                : moved * moved * double(memory_.counts[i]) / double(p.count - memory_.counts[i]);
        memory_.counts[i] = p.count;
        memory_.means[i] = p.mean;
    }
}

double NoiseEstimate::meanRadiance(const Film& film) const {
    double sum = 0;
    for (const PixelStatistics& p : film.pixels)
        sum += meanOfChannels(p.mean);
    return film.pixels.empty() ? 0 : sum / double(film.pixels.size());
}

PictureNoise NoiseEstimate::picture(const Film& film) const {
    return pictureNoise(film, memory_.squaredErrors);
}

std::vector<double> NoiseEstimate::relativeVariance(const Film& film) const {
    const double floor = kRelativeFloor * meanRadiance(film);
    std::vector<double> result(film.pixels.size(), 0.0);
    if (floor == 0) return result;
    std::vector<glm::dvec3> variances(film.pixels.size());
    for (size_t i = 0; i < variances.size(); ++i)
        variances[i] = memory_.squaredErrors[i] * double(memory_.counts[i]);
    tbb::parallel_for(0u, (film.height + kBand - 1) / kBand, [&](uint32_t band) {
        PixelWindows windows(film, variances, band * kBand);
        for (uint32_t y = band * kBand; y < std::min((band + 1) * kBand, film.height); ++y) {
            const std::vector<PixelGroup> row = windows.of(y);
            for (uint32_t x = 0; x < film.width; ++x) {
                const PixelGroup group = row[x].pixels > 0 ? row[x] : windows.alone(x, y);
                if (group.pixels == 0) continue;
                const glm::dvec3 mean = group.mean / group.pixels;
                result[size_t(y) * film.width + x] =
                    meanOfChannels(group.value / group.pixels / (mean * mean + floor * floor));
            }
        }
    });
    return result;
}

} // namespace stromboli

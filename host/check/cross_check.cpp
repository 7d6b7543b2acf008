#include "host/check/cross_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace stromboli {

double twoSidedProbability(double z) {
    return std::erfc(std::abs(z) / std::numbers::sqrt2);
}

double twoSidedQuantile(double probability) {
    // erfc of 40 / sqrt(2) is 0 in double; halving 64 times leaves less than one rounding.
    double low = 0, high = 40;
    for (int i = 0; i < 64; ++i) {
        const double middle = 0.5 * (low + high);
        (twoSidedProbability(middle) > probability ? low : high) = middle;
    }
    return high;
}

double sidakLevel(double familyError, uint64_t tests) {
    return -std::expm1(std::log1p(-familyError) / double(tests));
}

void Difference::add(const PixelStatistics& a, const PixelStatistics& b, int channel) {
    const double na = a.count, nb = b.count, n = na + nb;
    const double d = a.mean[channel] - b.mean[channel];
    sumA_ += a.mean[channel];
    sumB_ += b.mean[channel];
    const double own = a.varianceOfMean()[channel] + b.varianceOfMean()[channel];
    // E d^2 is the variance itself: both estimates are unbiased. For na = nb they are equal.
    separate_ += own * ((n - 2) / (n - 1)) + d * d / (n - 1);
    const double deviations = a.m2[channel] + b.m2[channel] + d * d * na * nb / n;
    pooled_ += deviations / (n - 1) * (n / (na * nb));
    const double both = 0.5 * (a.mean[channel] + b.mean[channel]);
    ownShare_ += both * both / (n - 1);
}

void Difference::add(const Difference& other) {
    sumA_ += other.sumA_;
    sumB_ += other.sumB_;
    separate_ += other.separate_;
    pooled_ += other.pooled_;
    ownShare_ += other.ownShare_;
}

double Difference::z(double rounding) const {
    const double d = sumA_ - sumB_;
    // Radiance is not negative, so the sums bound the sum of the pixels' own rounding errors.
    const double excess = std::abs(d) - rounding * std::max(sumA_, sumB_) - kUnderflow;
    if (excess <= 0) return 0;
    const double deviations = excess / std::sqrt(variance());
    // What is not a number agrees with nothing.
    return std::isnan(deviations) ? std::numeric_limits<double>::infinity()
                                  : std::copysign(deviations, d);
}

/// A relative difference x shifts the difference of the sums by x m, m the mean of both sums, and
/// makes its estimated variance v + x^2 q, q = ownShare_. It is found with probability `power`
/// where x m - p sqrt(v) - r = limit sqrt(v + x^2 q): p is the normal quantile of `power`, r what
/// rounding may explain. With c = p sqrt(v) + r this is a quadratic equation, of which the root
/// with x m > c is returned; there is none unless m > limit sqrt(q).
double Difference::visible(double limit, double power, double rounding) const {
    constexpr double kNothing = std::numeric_limits<double>::infinity();
    if (isBlack()) return kNothing;
    const double m = 0.5 * (sumA_ + sumB_), v = variance(), q = ownShare_;
    const double a = m * m - limit * limit * q;
    if (!(a > 0)) return kNothing;
    const double c = twoSidedQuantile(2 * (1 - power)) * std::sqrt(v) + rounding * m + kUnderflow;
    return (m * c + limit * std::sqrt(a * v + q * c * c)) / a;
}

namespace {

using ChannelDifferences = std::array<Difference, 3>;

/// Differences over a grid of square blocks; blocks without a compared pixel are not used.
struct Grid {
    uint32_t side = 1, columns = 0, rows = 0;
    std::vector<ChannelDifferences> sums;
    std::vector<char> used;

    Grid(uint32_t s, uint32_t width, uint32_t height)
        : side(s), columns((width + s - 1) / s), rows((height + s - 1) / s),
          sums(size_t(columns) * rows), used(sums.size(), 0) {}
    size_t blockOf(uint32_t x, uint32_t y) const { return size_t(y / side) * columns + x / side; }
};

/// The pixel's block in the grid, cut to the picture.
CheckBlock blockAt(const Grid& grid, size_t index, const Film& film) {
    CheckBlock block;
    block.x = uint32_t(index % grid.columns) * grid.side;
    block.y = uint32_t(index / grid.columns) * grid.side;
    block.width = std::min(grid.side, film.width - block.x);
    block.height = std::min(grid.side, film.height - block.y);
    return block;
}

Grid pixelGrid(const Film& a, const Film& b) {
    Grid grid(1, a.width, a.height);
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        if (a.pixels[i].count == 0 || b.pixels[i].count == 0) continue;
        grid.used[i] = 1;
        for (int c = 0; c < 3; ++c)
            grid.sums[i][c].add(a.pixels[i], b.pixels[i], c);
    }
    return grid;
}

Grid gather(const Grid& fine, uint32_t side, const Film& film) {
    Grid coarse(side, film.width, film.height);
    for (size_t i = 0; i < fine.sums.size(); ++i) {
        if (!fine.used[i]) continue;
        const CheckBlock at = blockAt(fine, i, film);
        const size_t target = coarse.blockOf(at.x, at.y);
        coarse.used[target] = 1;
        for (int c = 0; c < 3; ++c)
            coarse.sums[target][c].add(fine.sums[i][c]);
    }
    return coarse;
}

/// Largest |z| of a grid; `failing` counts the blocks beyond the limit in any channel.
CheckBlock worst(const Grid& grid, const Film& film, double rounding, double limit,
                 uint64_t& failing) {
    CheckBlock worstBlock;
    for (size_t i = 0; i < grid.sums.size(); ++i) {
        if (!grid.used[i]) continue;
        bool fails = false;
        for (int c = 0; c < 3; ++c) {
            const double z = grid.sums[i][c].z(rounding);
            fails = fails || !(std::abs(z) <= limit);
            if (worstBlock.width != 0 && std::abs(z) <= std::abs(worstBlock.z)) continue;
            worstBlock = blockAt(grid, i, film);
            worstBlock.channel = c;
            worstBlock.z = z;
        }
        if (fails) ++failing;
    }
    return worstBlock;
}

void checkChannels(const Grid& pixels, const CheckSettings& settings, double error,
                   CheckResult& result) {
    ChannelDifferences whole;
    for (const ChannelDifferences& pixel : pixels.sums)
        for (int c = 0; c < 3; ++c)
            whole[c].add(pixel[c]);
    result.channelLimit = twoSidedQuantile(sidakLevel(error, 3));
    result.channelsAgree = true;
    result.power = settings.power;
    for (int c = 0; c < 3; ++c) {
        CheckChannel& channel = result.channels[c];
        channel.meanA = whole[c].sumA() / double(result.pixels);
        channel.meanB = whole[c].sumB() / double(result.pixels);
        const double difference = channel.meanA - channel.meanB;
        channel.relativeDifference = difference == 0 ? 0 : difference / channel.meanB;
        channel.z = whole[c].z(settings.rounding);
        channel.isBlack = whole[c].isBlack();
        channel.visible = whole[c].visible(result.channelLimit, settings.power, settings.rounding);
        if (!(std::abs(channel.z) <= result.channelLimit)) result.channelsAgree = false;
    }
}

void checkBlocks(const Grid& pixels, const Film& film, const CheckSettings& settings, double error,
                 CheckResult& result) {
    std::vector<Grid> grids{gather(pixels, std::max(settings.blockSize, 1u), film)};
    while (grids.back().sums.size() > 1)
        grids.push_back(gather(grids.back(), 2 * grids.back().side, film));
    for (const Grid& grid : grids)
        result.blockTests += 3 * uint64_t(std::count(grid.used.begin(), grid.used.end(), 1));
    result.blockLimit = twoSidedQuantile(sidakLevel(error, result.blockTests));
    uint64_t failing = 0;
    for (const Grid& grid : grids) {
        const CheckBlock block = worst(grid, film, settings.rounding, result.blockLimit, failing);
        if (result.worstBlock.width == 0 || std::abs(block.z) > std::abs(result.worstBlock.z))
            result.worstBlock = block;
    }
    result.blocksAgree = failing == 0;
}

void checkPixels(const Grid& pixels, const Film& film, const CheckSettings& settings,
                 CheckResult& result) {
    result.pixelLimit = twoSidedQuantile(sidakLevel(settings.familyError, 3 * result.pixels));
    uint64_t failing = 0;
    result.worstPixel = worst(pixels, film, settings.rounding, result.pixelLimit, failing);
    result.fractionPassing = 1 - double(failing) / double(result.pixels);
    result.pixelsAgree = result.fractionPassing >= settings.requiredFraction;
}

/// Whether the samples differ by no more than rounding errors, as far as the film can tell: devices
/// keep squares of deviations as floats, the least of which is 2^-126.
bool isConstant(const PixelStatistics& pixel, int channel, const CheckSettings& settings) {
    constexpr double kLeastDeviation = 0x1p-63;
    const double mean = pixel.mean[channel], deviation = settings.rounding * mean;
    if (mean != 0 && deviation < kLeastDeviation) return false;
    return pixel.m2[channel] <= pixel.count * deviation * deviation;
}

/// Criterion 4 of crossCheck(), at level `error` for all pixels together.
void checkConstants(const Film& a, const Film& b, const CheckSettings& settings, double error,
                    CheckResult& result) {
    const double level = sidakLevel(error, result.pixels);
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const PixelStatistics &pa = a.pixels[i], &pb = b.pixels[i];
        const double fewest = std::min(pa.count, pb.count);
        // Either film may be the one with the value: twice the bound.
        if (fewest == 0 || 2 * std::exp2(-2 * fewest) > level) continue;
        bool differs = false;
        for (int c = 0; c < 3; ++c) {
            const double larger = std::max(pa.mean[c], pb.mean[c]);
            differs = differs ||
                      (isConstant(pa, c, settings) && isConstant(pb, c, settings) &&
                       std::abs(pa.mean[c] - pb.mean[c]) > settings.rounding * larger + kUnderflow);
        }
        if (differs) ++result.constantMismatches;
    }
    result.constantsAgree = result.constantMismatches == 0;
}

} // namespace

bool CheckResult::couldSee() const {
    constexpr double kBlackAgainstNot = 2; // (0 - m) / (m / 2)
    if (varied == 0) return false;
    const auto sees = [](const CheckChannel& c) { return c.visible < kBlackAgainstNot; };
    return std::ranges::any_of(channels, sees) ||
           std::ranges::all_of(channels, &CheckChannel::isBlack);
}

Verdict CheckResult::verdict() const {
    if (anyDiffers()) return Verdict::Different;
    return couldSee() ? Verdict::Agree : Verdict::Undecided;
}

CheckResult crossCheck(const Film& a, const Film& b, const CheckSettings& settings) {
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument("the films to compare have different sizes");
    CheckResult result;
    const Grid pixels = pixelGrid(a, b);
    result.pixels = uint64_t(std::count(pixels.used.begin(), pixels.used.end(), 1));
    for (size_t i = 0; i < a.pixels.size(); ++i)
        if (pixels.used[i] && std::max(a.pixels[i].count, b.pixels[i].count) > 1) ++result.varied;
    for (const PixelStatistics& p : a.pixels)
        result.rejectedA += p.rejected;
    for (const PixelStatistics& p : b.pixels)
        result.rejectedB += p.rejected;
    if (result.pixels == 0) return result; // nothing shows that they agree
    const double error = sidakLevel(settings.familyError, 3);
    checkChannels(pixels, settings, error, result);
    checkBlocks(pixels, a, settings, error, result);
    checkPixels(pixels, a, settings, result);
    checkConstants(a, b, settings, error, result);
    return result;
}

namespace {

constexpr const char* kChannelNames[] = {"red", "green", "blue"};

const char* verdict(bool agrees) {
    return agrees ? "ok" : "DIFFERENT";
}

std::string percent(const CheckChannel& c) {
    if (c.isBlack) return "black";
    return std::isfinite(c.visible) ? fmt::format("{:.3g} %", 100 * c.visible) : "nothing";
}

/// What the test of the means was able to see, whatever it found.
std::string formatSight(const CheckResult& r) {
    if (r.varied == 0) return "sight      unknown: no pixel has two samples\n";
    return fmt::format("sight      differences of the means found with {:g} % probability: from {} "
                       "(red), {} (green), {} (blue)\n",
                       100 * r.power, percent(r.channels[0]), percent(r.channels[1]),
                       percent(r.channels[2]));
}

std::string finalWord(const CheckResult& r) {
    switch (r.verdict()) {
    case Verdict::Agree:
        return "the pictures agree";
    case Verdict::Different:
        return "DIFFERENT";
    case Verdict::Undecided:
        break;
    }
    return r.varied == 0
               ? "UNDECIDED: no pixel has two samples, and so nothing tells noise from a difference"
               : "UNDECIDED: the noise would hide it if one picture were black; take more samples";
}

} // namespace

std::string formatCheck(const CheckResult& r) {
    if (r.pixels == 0) return "no pixel has samples in both pictures\nverdict: DIFFERENT\n";
    std::string text;
    for (int c = 0; c < 3; ++c) {
        const CheckChannel& channel = r.channels[c];
        text +=
            fmt::format("mean {:<6} {:.6g} and {:.6g}, {:+.3f} %, z = {:+.2f}\n", kChannelNames[c],
                        channel.meanA, channel.meanB, 100 * channel.relativeDifference, channel.z);
    }
    text += fmt::format("means      |z| <= {:.2f}: {}\n", r.channelLimit, verdict(r.channelsAgree));
    text += formatSight(r);
    const CheckBlock& block = r.worstBlock;
    text += fmt::format(
        "blocks     |z| <= {:.2f}: {}; worst z = {:+.2f} of {} at ({}, {}), {} x {}, {}\n",
        r.blockLimit, verdict(r.blocksAgree), block.z, r.blockTests, block.x, block.y, block.width,
        block.height, kChannelNames[block.channel]);
    text +=
        fmt::format("pixels     {:.3f} % with |z| <= {:.2f}: {}; worst z = {:+.2f} at "
                    "({}, {}), {}\n",
                    100 * r.fractionPassing, r.pixelLimit, verdict(r.pixelsAgree), r.worstPixel.z,
                    r.worstPixel.x, r.worstPixel.y, kChannelNames[r.worstPixel.channel]);
    text += fmt::format("constants  {} of {} pixels differ: {}\n", r.constantMismatches, r.pixels,
                        verdict(r.constantsAgree));
    if (r.rejectedA + r.rejectedB > 0)
        text += fmt::format("samples rejected: {} and {}\n", r.rejectedA, r.rejectedB);
    text += fmt::format("verdict: {}\n", finalWord(r));
    return text;
}

} // namespace stromboli

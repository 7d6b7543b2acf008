#include "host/check/cross_check.hpp"

#include "host/check/difference.hpp"
#include "host/check/normal.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace stromboli {
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
        const double mean = 0.5 * (channel.meanA + channel.meanB);
        channel.relativeDifference = mean > 0 ? (channel.meanA - channel.meanB) / mean : 0;
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

/// Whether the samples differ by no more than rounding errors.
bool isConstant(const PixelStatistics& pixel, int channel, const CheckSettings& settings) {
    const double deviation = settings.rounding * pixel.mean[channel];
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

} // namespace stromboli

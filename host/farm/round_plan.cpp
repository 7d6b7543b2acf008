#include "host/farm/round_plan.hpp"

#include "host/checkpoint/byte_parts.hpp"
#include "host/film/fixed_sum.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace stromboli {
namespace {

/// Side of a tile in pixels: what the kernel's lanes take side by side stays together.
constexpr uint32_t kTileSide = 8;

/// A permutation of 32 bits that leaves no order behind (the end of MurmurHash3, Appleby 2011).
uint32_t mixed(uint32_t bits) {
    bits = (bits ^ bits >> 16) * 0x85EBCA6Bu;
    bits = (bits ^ bits >> 13) * 0xC2B2AE35u;
    return bits ^ bits >> 16;
}

/// The pixels that get samples, in the order in which shares have them.
std::vector<PlannedPixel> inOrderOfShares(const RoundPlan& plan) {
    const uint32_t width = plan.picture.settings.area.rendered().width;
    const uint32_t tilesAcross = (width + kTileSide - 1) / kTileSide;
    std::vector<std::pair<uint32_t, PlannedPixel>> byTile;
    for (uint32_t i = 0; i < plan.from.size(); ++i)
        if (plan.to[i] > plan.from[i])
            byTile.push_back({mixed(i / width / kTileSide * tilesAcross + i % width / kTileSide),
                              {i, plan.from[i], plan.to[i]}});
    std::ranges::sort(byTile);
    std::vector<PlannedPixel> pixels(byTile.size());
    std::ranges::transform(byTile, pixels.begin(), [](const auto& entry) { return entry.second; });
    return pixels;
}

/// The first place of a share, or the number of all behind the last one: where its part of the
/// samples begins.
uint32_t firstPlaceOf(const std::vector<uint64_t>& samplesBefore, uint32_t share, uint32_t shares) {
    const auto begin = uint64_t(uint128(samplesBefore.back()) * (share - 1) / shares);
    return uint32_t(std::ranges::lower_bound(samplesBefore, begin) - samplesBefore.begin());
}

} // namespace

uint64_t RoundPlan::samples() const {
    uint64_t sum = 0;
    for (size_t i = 0; i < from.size(); ++i)
        sum += to[i] - from[i];
    return sum;
}

uint64_t RoundPlan::pixels() const {
    uint64_t count = 0;
    for (size_t i = 0; i < from.size(); ++i)
        count += to[i] > from[i];
    return count;
}

uint32_t checksumOf(const RoundPlan& plan) {
    std::vector<std::byte> bytes;
    for (const PlannedRound& round : plan.picture.planned)
        append(bytes, round.plan);
    append(bytes, plan.round());
    append(bytes, plan.from.data(), plan.from.size() * sizeof(uint32_t));
    append(bytes, plan.to.data(), plan.to.size() * sizeof(uint32_t));
    return checksumOf(std::span<const std::byte>(bytes));
}

PlannedShare ofShare(const RoundPlan& plan, const ShareName& share) {
    PlannedShare result{plan.picture, inOrderOfShares(plan)};
    std::vector<uint64_t> samplesBefore(result.pixels.size() + 1, 0); // of each place, and of all
    std::transform_inclusive_scan(
        result.pixels.begin(), result.pixels.end(), samplesBefore.begin() + 1, std::plus<>(),
        [](const PlannedPixel& pixel) { return uint64_t(pixel.to - pixel.from); });
    const uint32_t first = firstPlaceOf(samplesBefore, share.index, share.count);
    const uint32_t end = firstPlaceOf(samplesBefore, share.index + 1, share.count);

    FilmHeader& header = result.header;
    header.shares.clear();
    header.blocks.clear();
    header.holdsLayers = false;
    for (PlannedRound& round : header.planned)
        round = {round.plan, round.samples, 0, {}, {}};
    PlannedRound& round = header.planned.emplace_back();
    round.plan = checksumOf(plan);
    round.samples = samplesBefore.back();
    round.held = samplesBefore[end] - samplesBefore[first];
    round.shares = {share};
    if (first < end) round.places = {{first, end}};

    result.pixels = {result.pixels.begin() + first, result.pixels.begin() + end};
    std::ranges::sort(result.pixels);
    return result;
}

} // namespace stromboli

#include "host/farm/film_header.hpp"

#include "host/core/error.hpp"
#include "host/render/sampling_plan.hpp"
#include "host/render/sampling_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <tuple>
#include <utility>

namespace stromboli {

namespace {

/// Pixels of a run: 16 MiB of sums, so that several fit the caches and memory of any machine.
constexpr uint32_t kPixelsPerRun = 1u << 16;

/// In rising order, joined where they meet.
void join(std::vector<BlockRange>& blocks) {
    std::ranges::sort(blocks);
    std::vector<BlockRange> joined;
    for (const BlockRange& range : blocks) {
        if (!joined.empty() && joined.back().end == range.first)
            joined.back().end = range.end;
        else
            joined.push_back(range);
    }
    blocks = std::move(joined);
}

/// The numbers in words, runs of them shortened: "3 and 7 to 9".
std::string inWords(const std::vector<BlockRange>& runs) {
    std::string text;
    for (size_t i = 0; i < runs.size(); ++i) {
        if (i > 0) text += i + 1 == runs.size() ? " and " : ", ";
        text += runs[i].end - runs[i].first == 1
                    ? std::to_string(runs[i].first)
                    : fmt::format("{} to {}", runs[i].first, runs[i].end - 1);
    }
    return text;
}

/// What is left of [0, count).
std::vector<BlockRange> gapsOf(const std::vector<BlockRange>& blocks, uint32_t count) {
    std::vector<BlockRange> gaps;
    uint32_t next = 0;
    for (const BlockRange& range : blocks) {
        if (range.first > next) gaps.push_back({next, range.first});
        next = range.end;
    }
    if (next < count) gaps.push_back({next, count});
    return gaps;
}

/// What blocks hold of each pixel, as -s counts it.
BlockRange pathsOf(const FilmHeader& film, const BlockRange& range) {
    const uint32_t branches = film.settings.estimator.branches;
    return {film.allBlocks().firstOf(range.first) * branches,
            film.allBlocks().firstOf(range.end) * branches};
}

/// Throws the UsageError that the other's file holds what is held already.
[[noreturn]] void refuseTwice(const std::filesystem::path& file, const std::string& what) {
    throw UsageError(fmt::format("{}: {} would be counted twice", file.string(), what));
}

/// Adds shares of something, and the parts of it that they are. `ofRound`: behind the share's name;
/// `inWords`: what a range of parts is called.
template <class InWords>
void addShares(std::vector<ShareName>& shares, std::vector<BlockRange>& parts,
               const std::vector<ShareName>& otherShares, const std::vector<BlockRange>& otherParts,
               const std::filesystem::path& file, const std::string& ofRound,
               const InWords& partsInWords) {
    for (const ShareName& share : otherShares)
        if (std::ranges::binary_search(shares, share))
            refuseTwice(file, fmt::format("share {}{}", inWords(share), ofRound));
    for (const BlockRange& a : otherParts)
        for (const BlockRange& b : parts) {
            const uint32_t first = std::max(a.first, b.first), end = std::min(a.end, b.end);
            if (first < end) refuseTwice(file, partsInWords(BlockRange{first, end}));
        }
    shares.insert(shares.end(), otherShares.begin(), otherShares.end());
    std::ranges::sort(shares);
    parts.insert(parts.end(), otherParts.begin(), otherParts.end());
    join(parts);
}

/// "share 3 of 16 is missing"; nothing if the shares are of several divisions.
std::optional<std::string> missingShares(const std::vector<ShareName>& shares) {
    const uint32_t count = shares.empty() ? 0 : shares.front().count;
    if (count == 0 ||
        !std::ranges::all_of(shares, [&](const ShareName& share) { return share.count == count; }))
        return std::nullopt;
    std::vector<BlockRange> held;
    for (const ShareName& share : shares)
        held.push_back({share.index, share.index + 1});
    join(held);
    std::vector<BlockRange> missing = gapsOf(held, count + 1);
    if (!missing.empty() && missing.front().first == 0 &&
        ++missing.front().first == missing.front().end)
        missing.erase(missing.begin()); // shares count from 1
    const bool isOne = missing.size() == 1 && missing[0].end - missing[0].first == 1;
    return fmt::format("share{} {} of {} {} missing", isOne ? "" : "s", inWords(missing), count,
                       isOne ? "is" : "are");
}

std::string missingFromFirst(const FilmHeader& film) {
    if (const std::optional<std::string> shares = missingShares(film.shares)) return *shares;
    std::vector<BlockRange> samples;
    for (const BlockRange& gap : gapsOf(film.blocks, film.allBlocks().count()))
        samples.push_back(pathsOf(film, gap));
    return fmt::format("samples {} of each pixel are missing", inWords(samples));
}

std::string missingFrom(const PlannedRound& round) {
    if (round.held == 0) return "all samples are missing";
    if (const std::optional<std::string> shares = missingShares(round.shares)) return *shares;
    return fmt::format("{} of {} samples are missing", round.samples - round.held, round.samples);
}

} // namespace

std::string inWords(const ShareName& share) {
    return fmt::format("{}/{}", share.index, share.count);
}

size_t FilmHeader::layerChannels() const {
    size_t count = 0;
    for (const Layer layer : layers)
        count += holdsLayers ? channelsOf(layer).size() : 0;
    return count;
}

uint32_t FilmHeader::samples() const {
    uint32_t sum = 0;
    for (const BlockRange& range : blocks)
        sum += allBlocks().firstOf(range.end) - allBlocks().firstOf(range.first);
    return sum;
}

uint64_t FilmHeader::samplesHeld() const {
    uint64_t sum = samples() * settings.area.pixelCount();
    for (const PlannedRound& round : planned)
        sum += round.held;
    return sum;
}

uint64_t FilmHeader::samplesInAll() const {
    uint64_t sum = allBlocks().samples * settings.area.pixelCount();
    for (const PlannedRound& round : planned)
        sum += round.samples;
    return sum;
}

bool FilmHeader::isComplete() const {
    return samples() == allBlocks().samples &&
           std::ranges::all_of(planned, &PlannedRound::isComplete);
}

uint32_t FilmHeader::passOf(uint32_t block) const {
    const SampleBlocks all = allBlocks();
    if (all.samples < SamplingPlan::kFirstPass) return 0;
    return block < std::max(std::bit_floor(all.samples - 1) / all.perBlock, 1u) ? 0 : 1;
}

bool holdTheSame(const FilmHeader& one, const FilmHeader& other) {
    return one.shares == other.shares &&
           std::ranges::equal(one.planned, other.planned,
                              [](const PlannedRound& a, const PlannedRound& b) {
                                  return a.plan == b.plan && a.shares == b.shares;
                              });
}

FilmHeader ofShare(FilmHeader picture, const ShareName& share) {
    picture.planned.clear();
    picture.shares = {share};
    picture.blocks = {picture.allBlocks().ofShare(share.index, share.count)};
    picture.holdsLayers = !picture.layers.empty() && picture.blocks.front().first == 0;
    if (picture.blocks.front().empty()) picture.blocks.clear(), picture.holdsLayers = false;
    return picture;
}

uint32_t rowsPerRun(const PictureArea& area) {
    return std::max(kPixelsPerRun / area.rendered().width, 1u);
}

std::string differenceOf(const FilmHeader& one, const FilmHeader& other) {
    const RenderIdentity &a = one.identity, &b = other.identity;
    const Budget &x = one.settings.budget, &y = other.settings.budget;
    if (a.code != b.code)
        return fmt::format("was made by another build of the program, {}, which takes other "
                           "samples than {}",
                           b.program, a.program);
    if (a.sceneSum != b.sceneSum)
        return fmt::format("is of another scene or camera, or the scene's file was another ({})",
                           b.scene);
    if (a.backend != b.backend)
        return fmt::format("is of the backend {}, not {}", b.backend, a.backend);
    if (a.device != b.device)
        return fmt::format("was made on another kind of device, {}, not {}, whose samples are "
                           "rounded differently",
                           b.device, a.device);
    if (!sameArea(one.settings.area, other.settings.area))
        return fmt::format("is of another size or part of the picture, {} x {} pixels",
                           other.settings.area.rendered().width,
                           other.settings.area.rendered().height);
    // Branches are chosen by -s unless they are given, so that -s is compared first: in paths.
    const uint64_t m = one.settings.estimator.branches, n = other.settings.estimator.branches;
    if (x.mostSamplesPerPixel * m != y.mostSamplesPerPixel * n)
        return fmt::format("is of {} samples a pixel, not of {} (-s)", y.mostSamplesPerPixel * n,
                           x.mostSamplesPerPixel * m);
    if (m != n) return fmt::format("has {} branches a sample, not {} (--branches)", n, m);
    if (x.samplesPerBlock != y.samplesPerBlock)
        return fmt::format("is of blocks of {} samples, not of {} (--block)", y.samplesPerBlock * n,
                           x.samplesPerBlock * m);
    if (!sameEstimator(one.settings.estimator, other.settings.estimator))
        return "is of other settings: " + fmt::format("{}", fmt::join(other.command, " "));
    if (one.layers != other.layers) return "has other --layers";
    for (size_t i = 0; i < std::min(one.planned.size(), other.planned.size()); ++i)
        if (one.planned[i].plan != other.planned[i].plan)
            return fmt::format("follows another plan of round {} ({:08x}, not {:08x})", i + 2,
                               other.planned[i].plan, one.planned[i].plan);
    return "";
}

void add(FilmHeader& sum, const FilmHeader& other, const std::filesystem::path& file) {
    addShares(sum.shares, sum.blocks, other.shares, other.blocks, file, "",
              [&](const BlockRange& blocks) {
                  return fmt::format("samples {} of each pixel", inWords({pathsOf(sum, blocks)}));
              });
    for (size_t i = 0; i < other.planned.size(); ++i) {
        const PlannedRound& added = other.planned[i];
        if (i == sum.planned.size()) {
            sum.planned.push_back(added);
            continue;
        }
        PlannedRound& round = sum.planned[i];
        addShares(round.shares, round.places, added.shares, added.places, file,
                  fmt::format(" of round {}", i + 2), [&](const BlockRange& places) {
                      return fmt::format("round {} of {} pixels", i + 2, places.end - places.first);
                  });
        round.held += added.held;
    }
    sum.holdsLayers = sum.holdsLayers || other.holdsLayers;
    // Shares may have been given the scene by several names: the first of all, whatever the order.
    if (std::tie(other.command, other.scene) < std::tie(sum.command, sum.scene))
        std::tie(sum.command, sum.scene) = std::tie(other.command, other.scene);
    sum.identity.scene = std::min(sum.identity.scene, other.identity.scene);
    sum.identity.program = std::min(sum.identity.program, other.identity.program);
}

std::string missingFrom(const FilmHeader& film) {
    if (film.planned.empty()) return missingFromFirst(film);
    std::string text;
    const auto say = [&](size_t round, const std::string& what) {
        text += fmt::format("{}of round {} {}", text.empty() ? "" : "; ", round, what);
    };
    if (film.samples() < film.allBlocks().samples) say(1, missingFromFirst(film));
    for (size_t i = 0; i < film.planned.size(); ++i)
        if (!film.planned[i].isComplete()) say(i + 2, missingFrom(film.planned[i]));
    return text;
}

} // namespace stromboli

#include "host/farm/film_header.hpp"

#include "host/checkpoint/byte_parts.hpp"
#include "host/core/error.hpp"
#include "host/render/session_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

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

/// What no film says that this program wrote, and what others would not survive.
bool isPossible(const FilmHeader& header) {
    if (header.settings.area.pixelCount() == 0 || !header.settings.budget.isInBlocks())
        return false;
    uint32_t next = 0;
    for (const BlockRange& range : header.blocks) {
        if (range.first < next || range.end <= range.first) return false;
        next = range.end;
    }
    return next <= header.allBlocks().count() &&
           std::ranges::all_of(header.shares, [](const ShareName& share) {
               return share.index >= 1 && share.index <= share.count;
           });
}

} // namespace

std::string inWords(const ShareName& share) {
    return fmt::format("{}/{}", share.index, share.count);
}

uint32_t FilmHeader::samples() const {
    uint32_t sum = 0;
    for (const BlockRange& range : blocks)
        sum += allBlocks().firstOf(range.end) - allBlocks().firstOf(range.first);
    return sum;
}

bool FilmHeader::isComplete() const {
    return samples() == allBlocks().samples;
}

FilmHeader ofShare(FilmHeader picture, const ShareName& share) {
    picture.shares = {share};
    picture.blocks = {picture.allBlocks().ofShare(share.index, share.count)};
    if (picture.blocks.front().empty()) picture.blocks.clear();
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
    if (x.mostSamplesPerPixel != y.mostSamplesPerPixel)
        return fmt::format("is a share of {} samples a pixel, not of {}",
                           uint64_t(y.mostSamplesPerPixel) * other.settings.estimator.branches,
                           uint64_t(x.mostSamplesPerPixel) * one.settings.estimator.branches);
    if (x.samplesPerBlock != y.samplesPerBlock)
        return fmt::format("is of blocks of {} samples, not of {} (--block)", y.samplesPerBlock,
                           x.samplesPerBlock);
    if (!sameEstimator(one.settings.estimator, other.settings.estimator))
        return "is of other settings: " + fmt::format("{}", fmt::join(other.command, " "));
    return "";
}

void add(FilmHeader& sum, const FilmHeader& other, const std::filesystem::path& file) {
    const auto refuse = [&](const std::string& what) {
        throw UsageError(fmt::format("{}: {} would be counted twice", file.string(), what));
    };
    for (const ShareName& share : other.shares)
        if (std::ranges::binary_search(sum.shares, share)) refuse("share " + inWords(share));
    for (const BlockRange& a : other.blocks)
        for (const BlockRange& b : sum.blocks) {
            const uint32_t first = std::max(a.first, b.first), end = std::min(a.end, b.end);
            if (first < end)
                refuse(
                    fmt::format("samples {} of each pixel", inWords({pathsOf(sum, {first, end})})));
        }
    sum.shares.insert(sum.shares.end(), other.shares.begin(), other.shares.end());
    std::ranges::sort(sum.shares);
    sum.blocks.insert(sum.blocks.end(), other.blocks.begin(), other.blocks.end());
    join(sum.blocks);
    // Shares may have been given the scene by several names: the first of all, whatever the order.
    if (std::tie(other.command, other.scene) < std::tie(sum.command, sum.scene))
        std::tie(sum.command, sum.scene) = std::tie(other.command, other.scene);
    sum.identity.scene = std::min(sum.identity.scene, other.identity.scene);
    sum.identity.program = std::min(sum.identity.program, other.identity.program);
}

std::string missingFrom(const FilmHeader& film) {
    const uint32_t count = film.shares.empty() ? 0 : film.shares.front().count;
    const bool isOneDivision =
        count > 0 && std::ranges::all_of(
                         film.shares, [&](const ShareName& share) { return share.count == count; });
    if (isOneDivision) {
        std::vector<BlockRange> held;
        for (const ShareName& share : film.shares)
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
    std::vector<BlockRange> samples;
    for (const BlockRange& gap : gapsOf(film.blocks, film.allBlocks().count()))
        samples.push_back(pathsOf(film, gap));
    return fmt::format("samples {} of each pixel are missing", inWords(samples));
}

std::vector<std::byte> toBytes(const FilmHeader& header) {
    std::vector<std::byte> bytes;
    const RenderIdentity& identity = header.identity;
    append(bytes, identity.program);
    append(bytes, identity.code);
    append(bytes, identity.scene);
    append(bytes, identity.sceneSum);
    append(bytes, identity.backend);
    append(bytes, identity.device);
    append(bytes, header.scene);
    append(bytes, uint64_t(header.command.size()));
    for (const std::string& part : header.command)
        append(bytes, part);
    append(bytes, uint64_t(header.shares.size()));
    for (const ShareName& share : header.shares)
        append(bytes, share.index), append(bytes, share.count);
    append(bytes, uint64_t(header.blocks.size()));
    for (const BlockRange& range : header.blocks)
        append(bytes, range.first), append(bytes, range.end);
    SessionState settings;
    settings.settings = header.settings;
    const std::vector<std::byte> rest = toBytes(settings);
    append(bytes, rest.data(), rest.size());
    return bytes;
}

FilmHeader filmHeaderFromBytes(std::span<const std::byte> bytes,
                               const std::filesystem::path& file) {
    ByteParts parts(file, "film", bytes);
    FilmHeader header;
    RenderIdentity& identity = header.identity;
    identity.program = parts.text();
    identity.code = parts.text();
    identity.scene = parts.text();
    identity.sceneSum = parts.number<uint32_t>();
    identity.backend = parts.text();
    identity.device = parts.text();
    header.scene = parts.text();
    for (auto left = parts.number<uint64_t>(); left > 0; --left)
        header.command.push_back(parts.text());
    for (auto left = parts.number<uint64_t>(); left > 0; --left) {
        const auto index = parts.number<uint32_t>();
        header.shares.push_back({index, parts.number<uint32_t>()});
    }
    for (auto left = parts.number<uint64_t>(); left > 0; --left) {
        const auto first = parts.number<uint32_t>();
        header.blocks.push_back({first, parts.number<uint32_t>()});
    }
    try {
        header.settings = sessionFromBytes(parts.rest()).settings;
    } catch (const UsageError& error) {
        throw UsageError(fmt::format("{}: {}", file.string(), error.what()));
    }
    if (!isPossible(header))
        throw UsageError(fmt::format("{}: the film makes no sense", file.string()));
    return header;
}

} // namespace stromboli

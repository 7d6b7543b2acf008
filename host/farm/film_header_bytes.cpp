// What a film says of itself, as bytes.
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

/// Shares of something of so many parts, and those parts.
bool arePossible(const std::vector<ShareName>& shares, const std::vector<BlockRange>& parts,
                 uint64_t count) {
    uint32_t next = 0;
    for (const BlockRange& range : parts) {
        if (range.first < next || range.end <= range.first) return false;
        next = range.end;
    }
    return next <= count && std::ranges::all_of(shares, [](const ShareName& share) {
               return share.index >= 1 && share.index <= share.count;
           });
}

/// What no film says that this program wrote, and what others would not survive.
bool isPossible(const FilmHeader& header) {
    const uint64_t pixels = header.settings.area.pixelCount();
    if (pixels == 0 || !header.settings.budget.isInBlocks()) return false;
    if (!std::ranges::all_of(header.layers, [](Layer layer) {
            return std::ranges::count(kNamedValues<Layer>, layer, &NamedValue<Layer>::value) == 1;
        }))
        return false;
    if (header.holdsLayers && (header.layers.empty() || header.blocks.empty())) return false;
    return arePossible(header.shares, header.blocks, header.allBlocks().count()) &&
           std::ranges::all_of(header.planned, [&](const PlannedRound& round) {
               return round.samples > 0 && round.samples / kMostSamples <= pixels &&
                      round.held <= round.samples &&
                      arePossible(round.shares, round.places, pixels);
           });
}

void appendShares(std::vector<std::byte>& bytes, const std::vector<ShareName>& shares,
                  const std::vector<BlockRange>& parts) {
    append(bytes, uint64_t(shares.size()));
    for (const ShareName& share : shares)
        append(bytes, share.index), append(bytes, share.count);
    append(bytes, uint64_t(parts.size()));
    for (const BlockRange& range : parts)
        append(bytes, range.first), append(bytes, range.end);
}

void readShares(ByteParts& bytes, std::vector<ShareName>& shares, std::vector<BlockRange>& parts) {
    for (auto left = bytes.number<uint64_t>(); left > 0; --left) {
        const auto index = bytes.number<uint32_t>();
        shares.push_back({index, bytes.number<uint32_t>()});
    }
    for (auto left = bytes.number<uint64_t>(); left > 0; --left) {
        const auto first = bytes.number<uint32_t>();
        parts.push_back({first, bytes.number<uint32_t>()});
    }
}

} // namespace

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
    append(bytes, uint64_t(header.layers.size()));
    for (const Layer layer : header.layers)
        append(bytes, uint32_t(layer));
    append(bytes, uint64_t(header.legend.size()));
    for (const PictureNote& note : header.legend)
        append(bytes, note.name), append(bytes, note.text);
    append(bytes, uint32_t(header.holdsLayers));
    appendShares(bytes, header.shares, header.blocks);
    append(bytes, uint64_t(header.planned.size()));
    for (const PlannedRound& round : header.planned) {
        append(bytes, round.plan), append(bytes, round.samples), append(bytes, round.held);
        appendShares(bytes, round.shares, round.places);
    }
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
    for (auto left = parts.number<uint64_t>(); left > 0; --left)
        header.layers.push_back(Layer(parts.number<uint32_t>()));
    for (auto left = parts.number<uint64_t>(); left > 0; --left) {
        std::string name = parts.text();
        header.legend.push_back({std::move(name), parts.text()});
    }
    header.holdsLayers = parts.number<uint32_t>() != 0;
    readShares(parts, header.shares, header.blocks);
    for (auto left = parts.number<uint64_t>(); left > 0; --left) {
        PlannedRound& round = header.planned.emplace_back();
        round.plan = parts.number<uint32_t>();
        round.samples = parts.number<uint64_t>();
        round.held = parts.number<uint64_t>();
        readShares(parts, round.shares, round.places);
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

#pragma once

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/render/sample_blocks.hpp"
#include "host/render/settings.hpp"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

/// One of `count` shares of a picture's samples.
struct ShareName {
    uint32_t index = 1, count = 1; ///< index: from 1 to count
    auto operator<=>(const ShareName&) const = default;
};

/// "3/16".
std::string inWords(const ShareName& share);

/// What a film says of itself: of which picture it is, and which of its samples it holds.
struct FilmHeader {
    RenderIdentity identity;
    RenderSettings settings; ///< of the whole picture
    /// As the picture's notes say it: the scene's name, and the command that renders it in one go.
    std::string scene;
    std::vector<std::string> command;
    std::vector<ShareName> shares;  ///< in rising order
    std::vector<BlockRange> blocks; ///< in rising order, with gaps between them

    SampleBlocks allBlocks() const {
        return {settings.budget.mostSamplesPerPixel, settings.budget.samplesPerBlock};
    }
    /// Of a pixel, held here.
    uint32_t samples() const;
    bool isComplete() const;
};

/// The header of a film of one share, by that of its picture, whose shares and blocks do not count.
FilmHeader ofShare(FilmHeader picture, const ShareName& share);

/// Pixels of a film are kept, read and added up in runs of whole rows: this many rows.
uint32_t rowsPerRun(const PictureArea& area);

/// Why two films are not of the same picture, as the end of a sentence about the second: "is of
/// another scene"; empty: they are.
std::string differenceOf(const FilmHeader& one, const FilmHeader& other);

/// Adds what another film of the same picture holds. Throws UsageError, which begins with the name
/// of the other's file, if some of it is held already.
void add(FilmHeader& sum, const FilmHeader& other, const std::filesystem::path& file);

/// What an incomplete film lacks: "shares 3 and 7 to 9 of 16 are missing", or, where its shares are
/// of several divisions, "samples 64 to 127 are missing".
std::string missingFrom(const FilmHeader& film);

std::vector<std::byte> toBytes(const FilmHeader& header);
/// Throws UsageError, which names the file, if the bytes are none of this version.
FilmHeader filmHeaderFromBytes(std::span<const std::byte> bytes, const std::filesystem::path& file);

} // namespace stromboli

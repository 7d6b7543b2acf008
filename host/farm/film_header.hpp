#pragma once

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/layers.hpp"
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

/// A round of samples that a plan spread over the pixels, and what a film holds of it.
struct PlannedRound {
    uint32_t plan = 0;              ///< its checksum
    uint64_t samples = 0;           ///< of all pixels, planned
    uint64_t held = 0;              ///< of these, here
    std::vector<ShareName> shares;  ///< in rising order
    std::vector<BlockRange> places; ///< of pixels, in the plan's order of them, with gaps between
    bool isComplete() const { return held == samples; }
};

/// What a film says of itself: of which picture it is, and which of its samples it holds.
struct FilmHeader {
    RenderIdentity identity;
    RenderSettings settings; ///< of the whole picture
    /// What the picture's notes say: the scene's name, and the command that renders it in one go.
    std::string scene;
    std::vector<std::string> command;
    /// Channels beside the radiance, of which the film of a pixel's first samples has those of its
    /// first camera rays (docs/guide/layers.md), and what their numbers stand for.
    std::vector<Layer> layers;
    PictureNotes legend;
    bool holdsLayers = false;
    // The first round, in which all pixels have the same number of samples:
    std::vector<ShareName> shares;  ///< in rising order
    std::vector<BlockRange> blocks; ///< in rising order, with gaps between them
    /// The rounds after it, up to the last one that is known here, whether it is held or not.
    std::vector<PlannedRound> planned;

    /// Whether the picture has alpha: then films count the samples that a surface covers.
    bool hasAlpha() const { return !settings.estimator.showsBackdrop; }
    size_t layerChannels() const; ///< that it holds

    SampleBlocks allBlocks() const {
        return {settings.budget.mostSamplesPerPixel, settings.budget.samplesPerBlock};
    }
    uint32_t rounds() const { return uint32_t(planned.size()) + 1; }
    /// The samples of a pixel in the first round that are held here.
    uint32_t samples() const;
    /// The samples of all pixels and rounds that are held here, and those of all films together.
    uint64_t samplesHeld() const;
    uint64_t samplesInAll() const;
    bool isComplete() const;
    bool isEmpty() const { return samplesHeld() == 0; }
    /// The pass of a block of the first round, 0 or 1: what the later ones change says how large
    /// the error is that is left. They are those that `render --even` takes in its last pass, as
    /// far as blocks have it. Planned rounds are passes by their numbers, from 2 on.
    uint32_t passOf(uint32_t block) const;
};

/// Whether two films of the same picture hold the same samples of it.
bool holdTheSame(const FilmHeader& one, const FilmHeader& other);

/// The header of a film of one share, by that of its picture, whose shares and blocks do not count.
FilmHeader ofShare(FilmHeader picture, const ShareName& share);

/// Pixels of a film are kept, read and added up in runs of whole rows: this many rows.
uint32_t rowsPerRun(const PictureArea& area);

/// Why two films are not of the same picture, as the end of a sentence about the second: "is of
/// another scene"; empty: they are. One may know of rounds that come after those of the other.
std::string differenceOf(const FilmHeader& one, const FilmHeader& other);

/// Adds what another film of the same picture holds. Throws UsageError, which begins with the name
/// of the other's file, if some of it is held already.
void add(FilmHeader& sum, const FilmHeader& other, const std::filesystem::path& file);

/// What an incomplete film lacks: "shares 3 and 7 to 9 of 16 are missing", or, where its shares are
/// of several divisions, "samples 64 to 127 are missing"; of several rounds "of round 2 share 3 of
/// 16 is missing".
std::string missingFrom(const FilmHeader& film);

std::vector<std::byte> toBytes(const FilmHeader& header);
/// Throws UsageError, which names the file, if the bytes are none of this version.
FilmHeader filmHeaderFromBytes(std::span<const std::byte> bytes, const std::filesystem::path& file);

} // namespace stromboli

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace stromboli {

// A picture that is rendered in bands has a checkpoint for each, beside where that of the whole
// picture would be. Bands have about the same height (host/render/bands.hpp), so that their number
// says which rows each has.

/// FILE.band2of5 for the second one of five; `band` counts from 0.
std::filesystem::path bandFile(const std::filesystem::path& file, size_t band, size_t count);

/// The number of bands that the checkpoints beside the file are of; 0: there are none. Throws
/// UsageError if they are of different numbers: of two renders.
uint32_t bandsKept(const std::filesystem::path& file);

/// Removes the checkpoints of all bands, of however many. What cannot be removed stays.
void removeBandFiles(const std::filesystem::path& file);

} // namespace stromboli

#pragma once

#include "host/film/film.hpp"
#include "host/film/image.hpp"

#include <filesystem>

namespace stromboli {

/// Shows where the samples went, by q = samples taken / maximum: blue at 0, green at 1/2, red at
/// 1, linear in between, truncated to 8 bits (docs/cs184.md).
ByteImage ratePicture(const Film& film, uint32_t maximum);

/// Where the rate picture of a picture goes: `name.png` -> `name_rate.png`, beside it.
std::filesystem::path ratePicturePath(const std::filesystem::path& picture);

} // namespace stromboli

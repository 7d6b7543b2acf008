#include "host/denoise/stated_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stromboli::denoise {
namespace {

/// Side of the tiles, in pixels, whose errors are taken to know nothing of each other: half as much
/// again as the candidates reach.
constexpr uint32_t kTile = 16;
/// The fewest tiles at work for which a chi-square distribution stands for anything.
constexpr double kLeastTiles = 3;
constexpr double kZ = 1.96; ///< 97.5 % of the normal distribution

/// What the estimate of the relMSE may be off by besides chance: chosen so that most of the renders
/// of docs/results.md, "The denoiser", are within the range; they are few, so that its 95 % is an
/// intention and not a measured rate.
constexpr double kTooSmall = 1.5, kTooLarge = 3;

} // namespace

PictureNoise statedError(uint32_t width, uint32_t height, std::span<const PixelError> errors) {
    using Unknown = PictureNoise::Unknown;
    const uint32_t across = (width + kTile - 1) / kTile;
    std::vector<PixelError> tiles(size_t(across) * ((height + kTile - 1) / kTile));
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            PixelError& tile = tiles[size_t(y / kTile) * across + x / kTile];
            const PixelError& pixel = errors[size_t(y) * width + x];
            tile.error += pixel.error, tile.variance += pixel.variance;
        }
    // A tile's error is at least the noise that is left in it.
    double sum = 0, squares = 0;
    for (const PixelError& tile : tiles) {
        const double error = std::max(tile.error, tile.variance);
        sum += error, squares += error * error;
    }
    if (squares == 0) return {Unknown::No}; // no sample differs from another
    const double degrees = sum * sum / squares;
    if (!(sum > 0) || degrees < kLeastTiles) return {Unknown::TooFewPixels};
    const double relMse = sum / double(errors.size());
    return {Unknown::No, std::sqrt(relMse),
            std::sqrt(relMse * degrees / (chiSquareQuantile(degrees, kZ) * kTooLarge)),
            std::sqrt(relMse * degrees * kTooSmall / chiSquareQuantile(degrees, -kZ))};
}

} // namespace stromboli::denoise

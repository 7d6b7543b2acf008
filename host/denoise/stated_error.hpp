#pragma once

#include "host/render/picture_noise.hpp"

#include <cstdint>
#include <span>

namespace stromboli::denoise {

/// What a pixel adds to the relMSE of a denoised picture.
struct PixelError {
    double error = 0;    ///< an estimate whose expectation is right, and which may be negative
    double variance = 0; ///< the part of it that is noise, which is not
};

/// The square root of the relMSE of a denoised picture, with a range that is to hold it in 95 of
/// 100 renders. Pixels that are unknown have errors of 0.
PictureNoise statedError(uint32_t width, uint32_t height, std::span<const PixelError> errors);

} // namespace stromboli::denoise

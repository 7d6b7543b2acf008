#pragma once

#include "host/compare/metrics.hpp"
#include "host/core/json.hpp"
#include "host/view/frame.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace stromboli::view {

/// A picture that pages lay beside the one that is rendered.
struct ReferencePicture {
    compare::Picture picture;                 ///< black where the file has no finite number
    std::shared_ptr<const std::string> frame; ///< encodeFrame()
};

/// Throws UsageError if the file cannot be read.
std::shared_ptr<const ReferencePicture> readReference(const std::filesystem::path& file);

/// How radiance differs from the reference, as `compare` has it: relMse, mse, bias (of all channels
/// together, relative), psnr and ssim at an exposure of 0. Null if it has another size.
Json differenceJson(const ReferencePicture& reference, const Raster& radiance);

} // namespace stromboli::view

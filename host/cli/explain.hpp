#pragma once

#include "host/cli/options.hpp"

namespace stromboli {

/// `render --pixel`: tells of one pixel, or of one of its samples, what the kernel and the
/// reference make of it, and makes no picture. Returns the exit code. Throws UsageError if the
/// pixel is not in the picture.
int explainPixel(const RenderOptions& options);

} // namespace stromboli

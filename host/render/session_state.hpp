#pragma once

#include "host/render/backend.hpp"
#include "host/render/picture_noise.hpp"
#include "host/render/pixel_sums.hpp"
#include "host/render/settings.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace stromboli {

/// A render that has been stopped, as a plain value: all that a session needs to go on, apart from
/// the scene, the camera and the device.
struct SessionState {
    RenderSettings settings;
    std::vector<PixelSums> sums;         ///< as Backend::saveAll gives them
    std::vector<ExactStatistics> blocks; ///< as Backend::saveBlocks gives them
    NoiseEstimate::Memory estimate;      ///< of the passes that are done
    std::vector<PixelTarget> pending; ///< of the pass that was stopped; empty: between two passes
    double secondsUsed = 0;           ///< of StopRule::seconds
};

/// Whether they take the same samples.
bool sameEstimator(const Estimator& a, const Estimator& b);

/// For a file. Of this version and byte order of the program.
std::vector<std::byte> toBytes(const SessionState& state);
/// Throws UsageError if the bytes are damaged, cut short or of another version.
SessionState sessionFromBytes(std::span<const std::byte> bytes);

} // namespace stromboli

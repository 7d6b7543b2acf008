#pragma once

#include "host/denoise/denoiser.hpp"
#include "host/engine/render_request.hpp"
#include "host/film/film.hpp"
#include "host/film/image_file.hpp"
#include "host/render/backend.hpp"
#include "host/render/layers.hpp"
#include "host/render/picture_noise.hpp"
#include "host/render/settings.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

// --- Results -------------------------------------------------------------------------------------

/// Names one sample of a picture: column, row from the top, number.
struct SampleName {
    uint32_t x = 0, y = 0, sample = 0;
};

/// What a render did.
struct RenderResult {
    std::string backend; ///< device name, or the reference
    double buildSeconds = 0;
    double prepareSeconds = 0; ///< the device, the kernel, the film
    double renderSeconds = 0;
    RenderCounters counters;
    uint64_t samplesTaken = 0, samplesAtMost = 0, samplesRejected = 0; ///< in paths
    /// The first sample that was rejected: its pixel, and its number there.
    std::optional<SampleName> firstRejected;
    PictureNoise noise; ///< of the samples' means, whether these are denoised or not
    std::optional<denoise::Summary> denoised;
    uint64_t pixelsUnreached = 0;    ///< without samples
    size_t bands = 1;                ///< it was rendered in, one after the other
    bool cancelled = false;          ///< before it was finished
    std::optional<std::string> lost; ///< what the device said when it was lost for good
    std::string checkpoint;          ///< from which the render can go on; empty: there is none

    /// Nothing that was asked for is missing.
    bool complete() const { return !cancelled && !lost && pixelsUnreached == 0; }
};

/// Adds the samples and pixels of a band.
void count(const Film& film, const RenderSettings& settings, RenderResult& result);

// --- Channels of what is seen --------------------------------------------------------------------

/// The channels that a request asks for beside the radiance, of a film whose samples are taken
/// (docs/guide/layers.md), by the viewer of its picture; without one, all that there is is opaque
/// and unknown. Pixels without samples show the alpha of the ones that showNeighbours() shows.
/// isUnwanted: asked several times a second; where it says so, layers are not complete.
FloatImage seenChannels(Viewer* viewer, const Film& film, const Scene& scene, const Camera& camera,
                        const RenderRequest& request, const std::function<bool()>& isUnwanted = {});

/// The channels of the layers, pixel by pixel, as films of shares have them.
std::vector<float> layersByPixel(Viewer& viewer, const Film& film, const Scene& scene,
                                 const Camera& camera, const RenderRequest& request);

} // namespace stromboli

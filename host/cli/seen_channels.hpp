#pragma once

#include "host/cli/job.hpp"
#include "host/film/film.hpp"
#include "host/film/image.hpp"
#include "host/render/seeing.hpp"

#include <string>
#include <vector>

namespace stromboli {

/// The channels of --transparent and --layers.
std::vector<std::string> seenChannelNames(const Options& options);

/// These channels for a film whose samples are taken (docs/layers.md), by the viewer of its
/// picture; without one, all that there is is opaque and unknown. Pixels without samples show the
/// alpha of the ones that showNeighbours() shows.
FloatImage seenChannels(Viewer* viewer, const Film& film, const Job& job, const Options& options);

/// The channels of the layers, pixel by pixel, as films of shares have them.
std::vector<float> layersByPixel(Viewer& viewer, const Film& film, const Job& job,
                                 const Options& options);

} // namespace stromboli

#pragma once

#include "host/engine/render_request.hpp"
#include "host/film/film.hpp"
#include "host/film/image_file.hpp"
#include "host/render/layers.hpp"

#include <vector>

namespace stromboli {

/// The channels that a request asks for beside the radiance, of a film whose samples are taken
/// (docs/layers.md), by the viewer of its picture; without one, all that there is is opaque and
/// unknown. Pixels without samples show the alpha of the ones that showNeighbours() shows.
FloatImage seenChannels(Viewer* viewer, const Film& film, const Scene& scene, const Camera& camera,
                        const RenderRequest& request);

/// The channels of the layers, pixel by pixel, as films of shares have them.
std::vector<float> layersByPixel(Viewer& viewer, const Film& film, const Scene& scene,
                                 const Camera& camera, const RenderRequest& request);

} // namespace stromboli

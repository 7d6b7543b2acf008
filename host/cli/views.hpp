#pragma once

#include "host/cli/options.hpp"
#include "scene/model/scene.hpp"

#include <vector>

namespace stromboli {

/// The options of each of the pictures that a render is to make of a scene: Options::cameras, each
/// with files of its own. Throws SceneError if the scene lacks one of the cameras, UsageError if
/// one is named twice.
std::vector<Options> optionsOfPictures(const Options& asked, const Scene& scene);

} // namespace stromboli

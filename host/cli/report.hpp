#pragma once

#include "host/engine/render_result.hpp"
#include "host/film/shown_film.hpp"
#include "host/render/picture_noise.hpp"
#include "scene/model/scene.hpp"

#include <string>

namespace stromboli {

/// What a render did, for the closing lines and --stats.
struct RenderReport {
    RenderResult render;
    double loadSeconds = 0, writeSeconds = 0;
    bool isShare = false; ///< of a picture whose noise shows in all shares together
};

/// "noise about 2 % (95 % range: 1.5 to 2.6 %)", or why it is unknown.
std::string inWords(const PictureNoise& noise);
/// A share in percent, with two digits that say something: 0.0234 is 2.3.
std::string percent(double share);
/// Logs time, paths, rays, Mrays/s, samples, noise, and the first rejected sample if there is one.
void logReport(const RenderReport& report, const RenderSettings& settings);
/// Says so if hardly anything can be seen in the picture, and what would help.
void logBrightness(const Brightness& brightness, const Scene& scene, const std::string& file);
/// Throws OutputError.
void writeStatistics(const std::string& file, const RenderReport& report, const Scene& scene,
                     const RenderSettings& settings);

} // namespace stromboli

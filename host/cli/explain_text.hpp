#pragma once

#include "host/core/json.hpp"
#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/recorded_path.hpp"
#include "scene/model/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// What one backend makes of a pixel.
struct PixelByBackend {
    std::string name; ///< kernel or reference
    PixelStatistics statistics;
    std::vector<SampleValue> samples; ///< from number 0 on
};

/// What one backend makes of a sample.
struct PathByBackend {
    std::string name;
    bool isFloat = false; ///< nine digits tell any two numbers apart, else seventeen
    RecordedPath path;
};

/// The samples that are brightest, by luminance, not more than `most`: their numbers.
std::vector<uint32_t> heaviestSamples(const std::vector<SampleValue>& samples, size_t most);

/// Of the difference of both means, in its standard errors, the largest of the channels; nothing
/// without two samples each.
std::optional<double> deviationOf(const PixelStatistics& a, const PixelStatistics& b);

std::string textOfPixel(const std::vector<PixelByBackend>& all);
Json jsonOfPixel(const std::vector<PixelByBackend>& all);

/// The first is the path that was taken; a second one is the same path by the reference.
std::string textOfPath(const std::vector<PathByBackend>& all, const Scene& scene);
Json jsonOfPath(const std::vector<PathByBackend>& all, const Scene& scene);

/// "accepted", or why the sample is rejected.
std::string verdictOn(const glm::dvec3& radiance, bool rejected);

} // namespace stromboli

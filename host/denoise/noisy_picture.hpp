#pragma once

#include "host/film/film.hpp"
#include "host/film/image.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stromboli::denoise {

/// A picture that is to be denoised: rows from the top, width * height values in each list.
struct NoisyPicture {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> mean; ///< radiance
    /// Half of what two equal shares of a pixel's samples differ by: mean + deviation and mean -
    /// deviation are means of independent errors, and the expectation of its square is the variance
    /// of the mean. Which share is which, hence its sign, means nothing.
    std::vector<glm::vec3> deviation;
    /// The mean's, by the samples' own spread; empty: not known beside the deviation.
    std::vector<glm::vec3> variance;
    /// How much of the squared deviation is error of the mean (gap_filling.hpp); empty: all of it.
    /// It goes into what is predicted of the error, and not into what is chosen by it: a share that
    /// is too low leaves noise, which costs more than the blur that one too high brings
    /// (docs/results.md, "The denoiser").
    std::vector<float> errorShare;
    std::vector<glm::vec3> albedo, normal; ///< empty: not known
    std::vector<float> depth;              ///< empty: not known; infinite where nothing is seen
    /// Pixels whose radiance or deviation is no number, or was never sampled: they show their
    /// neighbours, and none of these looks at them.
    uint64_t unknownPixels = 0;

    size_t pixelCount() const { return size_t(width) * height; }
};

/// A film, and estimates of the squared errors of its means, by pixel and channel (NoiseEstimate):
/// what a half of the samples has moved the mean by. Layers are those of the channels albedo.R,
/// normal.X, depth.Z (host/render/layers.hpp); what is not there is not known.
NoisyPicture noisyPictureOf(const Film& film, std::span<const glm::dvec3> squaredErrors,
                            const FloatImage& layers);

/// A picture in a file. The channels go by the names of this program and of others
/// (docs/guide/denoise.md). `file` is for messages. Throws UsageError, saying what is missing and
/// what there is.
NoisyPicture noisyPictureOf(const FloatImage& image, const std::string& file);

} // namespace stromboli::denoise

#pragma once

#include "host/film/picture_area.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace stromboli {

/// Running statistics of one pixel's samples (linear RGB radiance).
struct PixelStatistics {
    uint32_t count = 0;                   ///< samples in the mean; rejected ones are not
    uint32_t rejected = 0;                ///< samples whose radiance was not finite or negative
    uint32_t firstRejected = 0xFFFFFFFFu; ///< index of the first rejected sample
    glm::dvec3 mean{0.0};
    glm::dvec3 m2{0.0}; ///< sum of squared deviations from the mean (Welford 1962)

    uint32_t taken() const { return count + rejected; }
    /// Unbiased variance of one sample, per channel; 0 for fewer than two samples.
    glm::dvec3 variance() const;
    /// Variance of the mean.
    glm::dvec3 varianceOfMean() const;
    /// Adds one sample; rejects it if a channel is not finite or is negative. weight: that of its
    /// place by a pixel filter, which may be negative.
    void add(const glm::dvec3& radiance, double weight = 1);
    /// Chan, Golub and LeVeque 1979: statistics of the union of two sets of samples. The other's
    /// samples follow these: its firstRejected counts from its own first sample.
    void merge(const PixelStatistics& other);
};

/// The part of a picture that is rendered, in the making: row 0 is the top, pixel (x, y) of the
/// part is pixels[y * width + x].
struct Film {
    uint32_t width = 0, height = 0; ///< of the part
    PictureArea area;               ///< where the part lies in the whole picture
    std::vector<PixelStatistics> pixels;
    uint32_t branches = 1; ///< paths of a sample (docs/estimator.md, "Branches")

    Film() = default;
    explicit Film(const PictureArea& a)
        : width(a.rendered().width), height(a.rendered().height), area(a), pixels(a.pixelCount()) {}
    /// A whole picture.
    Film(uint32_t w, uint32_t h) : Film(PictureArea{w, h, {}}) {}
    PixelStatistics& at(uint32_t x, uint32_t y) { return pixels[size_t(y) * width + x]; }
    const PixelStatistics& at(uint32_t x, uint32_t y) const {
        return pixels[size_t(y) * width + x];
    }
};

} // namespace stromboli

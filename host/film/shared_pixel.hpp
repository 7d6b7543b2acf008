#pragma once

#include "host/film/exact_statistics.hpp"

#include <array>
#include <cstdint>

namespace stromboli {

/// A pixel of a film that several machines fill: of all its samples, and how much of them the last
/// pass over it took, which says how large the error is that is left (docs/estimator.md, "How noisy
/// a picture is"). Can be put together in any order and grouping, to the same bits.
struct SharedPixel {
    ExactStatistics all;
    /// Of the samples taken, where the picture has alpha: those whose camera ray ends on a surface.
    uint32_t covered = 0;
    /// Of the samples in the mean: the number of the latest pass among them, and what it added.
    uint32_t lastPass = 0, lastCount = 0;
    std::array<ExactStatistics::Sum, 3> lastSum;

    /// Adds samples that pass number `pass` took, the first of which is the pixel's sample
    /// `firstSample`. Throws SceneError if their radiance is out of range.
    void add(const PixelStatistics& samples, uint32_t firstSample, uint32_t pass);
    void add(const SharedPixel& other);
    /// The same where the samples of the other one are all of its last pass, of which it need not
    /// know more than the number.
    void addOfOnePass(const SharedPixel& other);
    /// The share of its samples that a surface covers.
    float alpha() const { return all.taken() > 0 ? float(double(covered) / all.taken()) : 0.0f; }
    /// Whether no pass was before the last one.
    bool isOfOnePass() const { return lastCount == all.count && lastSum == all.sum; }
    /// An estimate of the squared error of the mean: from what the last pass changed or, where it
    /// is the only one, from the variance of the samples (NoiseEstimate).
    glm::dvec3 squaredError() const;

    bool operator==(const SharedPixel&) const = default;

  private:
    void addToLast(uint32_t pass, uint32_t count, const std::array<ExactStatistics::Sum, 3>& sum);
};

} // namespace stromboli

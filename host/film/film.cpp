#include "host/film/film.hpp"

#include "host/core/error.hpp"

#include <algorithm>
#include <limits>

namespace stromboli {

// --- Films ---------------------------------------------------------------------------------------

/// Written as ordered comparisons, which NaN fails.
static bool isRadiance(double value) {
    return value >= 0 && value <= std::numeric_limits<double>::max();
}

glm::dvec3 PixelStatistics::variance() const {
    if (count < 2) return glm::dvec3(0.0);
    return m2 / double(count - 1);
}

glm::dvec3 PixelStatistics::varianceOfMean() const {
    if (count < 2) return glm::dvec3(0.0);
    return variance() / double(count);
}

void PixelStatistics::add(const glm::dvec3& radiance, double weight) {
    if (!isRadiance(radiance.x) || !isRadiance(radiance.y) || !isRadiance(radiance.z)) {
        if (rejected == 0) firstRejected = taken();
        ++rejected;
        return;
    }
    ++count;
    const glm::dvec3 value = weight * radiance;
    const glm::dvec3 delta = value - mean;
    mean += delta / double(count);
    m2 += delta * (value - mean);
}

void PixelStatistics::merge(const PixelStatistics& other) {
    if (rejected == 0 && other.rejected > 0) firstRejected = taken() + other.firstRejected;
    rejected += other.rejected;
    if (other.count == 0) return;

    const double here = count, there = other.count, both = here + there;
    const glm::dvec3 delta = other.mean - mean;
    mean += delta * (there / both);
    m2 += other.m2 + delta * delta * (here * there / both);
    count += other.count;
}

void PixelStatistics::mergeStrand(const PixelStatistics& other, uint32_t strand, uint32_t strands) {
    uint32_t first = firstRejected;
    if (other.rejected > 0) first = std::min(first, other.firstRejected * strands + strand);
    merge(other);
    firstRejected = first;
}

// --- Statistics that add up exactly --------------------------------------------------------------

namespace {

using Sum = ExactStatistics::Sum;
using Squares = ExactStatistics::Squares;

/// 2^48, as the kernel has it (shaders/include/accumulate.glsl). With 2^24 samples, sums are at
/// most 2^72 and sums of squares 2^120, of squared deviations as well. Pixel filters may weigh and
/// negate samples: a block beyond these bounds is refused.
constexpr double kLargestRadiance = 281474976710656.0;
static_assert(Sum::kLimit > 72 && Squares::kLimit > 121);

/// The square of the first 64 digits of a sum, over the number of samples, to 2^-102 of it at
/// least: 128 digits less those of the largest count, and of the square's own leading one. Exactly
/// where it has no more digits, as that of equal samples.
Squares squareOver(const Sum& sum, uint32_t count) {
    const Sum::Top t = sum.magnitude().top();
    const uint128 square = uint128(t.digits) * t.digits;
    Squares result;
    result.add(std::has_single_bit(count) ? square >> std::countr_zero(count) : square / count,
               2 * t.exponent);
    return result;
}

} // namespace

void ExactStatistics::add(const PixelStatistics& block, uint32_t firstSample) {
    if (block.rejected > 0) {
        rejected += block.rejected;
        firstRejected = std::min(firstRejected, firstSample + block.firstRejected);
    }
    if (block.count == 0) return;
    count += block.count;
    for (int c = 0; c < 3; ++c) {
        const double total = block.mean[c] * block.count;
        if (!(std::abs(block.mean[c]) <= kLargestRadiance &&
              block.m2[c] <= kLargestRadiance * kLargestRadiance * block.count))
            throw SceneError("a pixel is brighter than 2^48, the most that films of shares hold");
        Sum ofBlock;
        ofBlock.add(total);
        sum[size_t(c)].add(ofBlock);
        squares[size_t(c)].add(block.m2[c]);
        squares[size_t(c)].add(squareOver(ofBlock, block.count));
    }
}

void ExactStatistics::add(const ExactStatistics& other) {
    count += other.count;
    rejected += other.rejected;
    firstRejected = std::min(firstRejected, other.firstRejected);
    for (size_t c = 0; c < 3; ++c) {
        sum[c].add(other.sum[c]);
        squares[c].add(other.squares[c]);
    }
}

PixelStatistics ExactStatistics::statistics() const {
    PixelStatistics p;
    p.count = count;
    p.rejected = rejected;
    p.firstRejected = firstRejected;
    if (count == 0) return p;
    for (int c = 0; c < 3; ++c) {
        p.mean[c] = sum[size_t(c)].value() / double(count);
        p.m2[c] = squares[size_t(c)].less(squareOver(sum[size_t(c)], count)).value();
    }
    return p;
}

void SharedPixel::add(const PixelStatistics& samples, uint32_t firstSample, uint32_t pass) {
    SharedPixel other;
    other.all.add(samples, firstSample);
    other.lastPass = pass;
    addOfOnePass(other);
}

void SharedPixel::addOfOnePass(const SharedPixel& other) {
    all.add(other.all);
    covered += other.covered;
    addToLast(other.lastPass, other.all.count, other.all.sum);
}

void SharedPixel::add(const SharedPixel& other) {
    all.add(other.all);
    covered += other.covered;
    addToLast(other.lastPass, other.lastCount, other.lastSum);
}

/// The later pass wins, and parts of one pass add up: whatever comes first, the same is left.
void SharedPixel::addToLast(uint32_t pass, uint32_t count,
                            const std::array<ExactStatistics::Sum, 3>& sum) {
    if (count == 0 || pass < lastPass) return;
    if (pass > lastPass) lastPass = pass, lastCount = 0, lastSum = {};
    lastCount += count;
    for (size_t c = 0; c < 3; ++c)
        lastSum[c].add(sum[c]);
}

glm::dvec3 SharedPixel::squaredError() const {
    const PixelStatistics now = all.statistics();
    const uint32_t before = all.count - lastCount;
    if (before == 0 || lastCount == 0) return now.varianceOfMean();
    glm::dvec3 moved;
    for (size_t c = 0; c < 3; ++c) {
        ExactStatistics::Sum first = all.sum[c]; // of either sign, as the last ones are
        first.add(lastSum[c].negated());
        moved[int(c)] = now.mean[int(c)] - first.value() / double(before);
    }
    return moved * moved * double(before) / double(lastCount);
}

} // namespace stromboli

#include "host/film/shared_pixel.hpp"

namespace stromboli {

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

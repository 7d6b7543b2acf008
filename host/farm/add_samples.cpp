#include "host/farm/add_samples.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace stromboli {

void addSamples(std::span<SharedPixel> pixels, std::span<const PixelTarget> targets,
                const Film& taken, uint32_t firstSample, uint32_t pass) {
    constexpr size_t kTargetsAtOnce = 4096;
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, targets.size(), kTargetsAtOnce), [&](const auto& range) {
            for (size_t i = range.begin(); i != range.end(); ++i)
                pixels[targets[i].pixel].add(taken.pixels[targets[i].pixel], firstSample, pass);
        });
}

} // namespace stromboli

#include "host/farm/picture_parts.hpp"

#include "host/film/image_file.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace stromboli {
namespace {

/// Of a part: 64 of 65,536 pixels each.
constexpr uint32_t kRunsPerPart = 64;

} // namespace

PictureParts::PictureParts(const FilmHeader& header, Take take)
    : header_(header), take_(std::move(take)), rowsLeft_(header.settings.area.rendered().height) {}

void PictureParts::begin() {
    const PictureArea& area = header_.settings.area;
    const Crop all = area.rendered();
    const uint64_t atMost = uint64_t(rowsPerRun(area)) * kRunsPerPart;
    const auto rows = uint32_t(std::min<uint64_t>(atMost, rowsLeft_));
    part_ = Film(PictureArea{
        area.width, area.height, {all.x, all.y + all.height - rowsLeft_, all.width, rows}});
    part_.branches = header_.settings.estimator.branches;
    errors_.counts.resize(part_.pixels.size());
    errors_.means.resize(part_.pixels.size());
    errors_.squaredErrors.resize(part_.pixels.size());
    more_ = FloatImage(part_.area);
    rowsLeft_ -= rows;
    next_ = 0;
}

void PictureParts::addChannels(std::span<const SharedPixel> run, std::span<const float> layers) {
    if (header_.hasAlpha()) {
        std::vector<float>& alpha = more_.channel(kAlphaChannel);
        for (size_t i = 0; i < run.size(); ++i)
            alpha[next_ + i] = run[i].alpha();
    }
    const size_t channels = header_.layerChannels();
    size_t channel = 0;
    for (const Layer layer : header_.layers)
        for (const std::string& name : channelsOf(layer)) {
            std::vector<float>& values = more_.channel(name);
            for (size_t i = 0; i < run.size() && !layers.empty(); ++i)
                values[next_ + i] = layers[i * channels + channel];
            ++channel;
        }
}

void PictureParts::add(std::span<const SharedPixel> run, std::span<const float> layers) {
    if (next_ == part_.pixels.size()) begin();
    tbb::parallel_for(tbb::blocked_range<size_t>(0, run.size(), 1024), [&](const auto& range) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
            const PixelStatistics p = run[i].all.statistics();
            part_.pixels[next_ + i] = p;
            errors_.counts[next_ + i] = p.count;
            errors_.means[next_ + i] = p.mean;
            errors_.squaredErrors[next_ + i] = run[i].squaredError();
        }
    });
    addChannels(run, layers);
    next_ += run.size();
    if (next_ < part_.pixels.size()) return;
    NoiseEstimate estimate;
    estimate.remember(std::move(errors_));
    take_(part_, estimate, more_);
    errors_ = {};
}

} // namespace stromboli

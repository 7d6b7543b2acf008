#include "host/farm/picture_parts.hpp"

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
    rowsLeft_ -= rows;
    next_ = 0;
}

void PictureParts::add(std::span<const SharedPixel> run) {
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
    next_ += run.size();
    if (next_ < part_.pixels.size()) return;
    NoiseEstimate estimate;
    estimate.remember(std::move(errors_));
    take_(part_, estimate);
    errors_ = {};
}

} // namespace stromboli

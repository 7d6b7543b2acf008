#include "host/farm/shared_band.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <utility>

namespace stromboli {
namespace {

std::vector<PixelTarget> allPixels(const PictureArea& area, uint32_t samples) {
    std::vector<PixelTarget> targets(area.pixelCount());
    for (uint32_t i = 0; i < targets.size(); ++i)
        targets[i] = {i, samples};
    return targets;
}

} // namespace

SharedBand::SharedBand(Backend& backend, const PictureArea& band, Progress progress)
    : backend_(backend), band_(band), progress_(std::move(progress)), sums_(band.pixelCount()) {}

bool SharedBand::take(uint32_t first, std::span<const PixelTarget> targets, uint32_t pass) {
    Film film(band_);
    bool goesOn = true;
    uint64_t told = 0;
    backend_.beginAt(first);
    backend_.sample(targets, film, [&](uint64_t done) {
        // Of several devices, one may be lost with what it had said to be done.
        const uint64_t more = done > told ? done - told : 0;
        told = std::max(told, done);
        return goesOn = progress_(more) && goesOn;
    });
    if (!goesOn) return false;
    addSamples(sums_, targets, film, first, pass);
    if (viewer_) addCovered(first, targets);
    return true;
}

bool SharedBand::takeBlocks(const FilmHeader& header) {
    const SampleBlocks all = header.allBlocks();
    for (const BlockRange& range : header.blocks)
        for (uint32_t block = range.first; block < range.end; ++block) {
            const uint32_t first = all.firstOf(block);
            const uint32_t samples = all.firstOf(block + 1) - first;
            if (!take(first, allPixels(band_, samples), header.passOf(block))) return false;
        }
    return true;
}

/// Pixels that have as many samples until now go together: there are few such numbers.
bool SharedBand::takePlanned(std::span<const PlannedPixel> pixels, uint32_t firstPixel,
                             uint32_t pass) {
    std::map<uint32_t, std::vector<PixelTarget>> alike;
    for (const PlannedPixel& p : pixels)
        alike[p.from].push_back({p.pixel - firstPixel, p.to - p.from});
    for (const auto& [first, targets] : alike)
        if (!take(first, targets, pass)) return false;
    return true;
}

Film SharedBand::film() const {
    Film film(band_);
    for (size_t i = 0; i < sums_.size(); ++i)
        film.pixels[i] = sums_[i].all.statistics();
    return film;
}

/// By the camera rays of the very samples.
void SharedBand::addCovered(uint32_t firstSample, std::span<const PixelTarget> targets) {
    std::vector<uint32_t> samples(sums_.size(), 0);
    for (const PixelTarget& t : targets)
        samples[t.pixel] = t.samples;
    for (size_t begin = 0; begin < samples.size(); begin += Viewer::kMostSeenAtOnce) {
        const std::span<const uint32_t> run = std::span(samples).subspan(
            begin, std::min<size_t>(Viewer::kMostSeenAtOnce, samples.size() - begin));
        if (std::ranges::count(run, 0u) == std::ssize(run)) continue;
        const auto seen = viewer_()->see(uint32_t(begin), run, Seeing::Coverage, firstSample);
        for (size_t i = 0; i < seen.size(); ++i)
            sums_[begin + i].covered += seen[i].hits;
    }
}

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

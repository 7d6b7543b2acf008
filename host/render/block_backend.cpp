#include "host/render/block_backend.hpp"

#include "host/render/sampling_plan.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <stdexcept>

namespace stromboli {

// --- Bands ---------------------------------------------------------------------------------------

uint64_t hostBytesPerPixel(bool inBlocks) {
    constexpr uint64_t kFilm = sizeof(PixelStatistics);
    // NoiseEstimate: count, mean, squared error; variances of one sample, as sums and relative.
    constexpr uint64_t kEstimate = sizeof(uint32_t) + 4 * sizeof(glm::dvec3) + sizeof(double);
    // The pass, as planned, in the order of work, and as the device's items of 16 bytes.
    constexpr uint64_t kWork = 2 * sizeof(PixelTarget) + 16;
    // What a share keeps besides; a render in one go knows nothing of last passes.
    const uint64_t blocks = inBlocks ? kFilm + sizeof(SharedPixel) : 0;
    return kFilm + kEstimate + kWork + NoisePlan::kBytesPerPixel + blocks;
}

std::vector<PictureArea> bandsOf(const PictureArea& area, uint64_t pixels) {
    const Crop all = area.rendered();
    const uint64_t rowsThatFit = std::clamp<uint64_t>(pixels / all.width, 1, all.height);
    return inBands(area, uint32_t((all.height + rowsThatFit - 1) / rowsThatFit));
}

std::vector<PictureArea> inBands(const PictureArea& area, uint32_t count) {
    const Crop all = area.rendered();
    if (count == 1) return {area};
    std::vector<PictureArea> bands;
    for (uint32_t i = 0; i < count; ++i) {
        const auto first = uint32_t(uint64_t(all.height) * i / count);
        const auto end = uint32_t(uint64_t(all.height) * (i + 1) / count);
        bands.push_back({area.width, area.height, {all.x, all.y + first, all.width, end - first}});
    }
    return bands;
}

// --- Adding up block by block --------------------------------------------------------------------

namespace {

constexpr size_t kPixelsAtOnce = 4096;

} // namespace

void BlockSums::add(const Film& block, uint32_t firstSample) {
    pixels_.resize(block.pixels.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, pixels_.size(), kPixelsAtOnce),
                      [&](const auto& range) {
                          for (size_t i = range.begin(); i != range.end(); ++i)
                              pixels_[i].add(block.pixels[i], firstSample);
                      });
}

void BlockSums::restore(std::span<const ExactStatistics> pixels) {
    pixels_.assign(pixels.begin(), pixels.end());
}

BlockBackend::BlockBackend(std::shared_ptr<Backend> inner, const PictureArea& area,
                           uint32_t samplesPerBlock)
    : inner_(std::move(inner)), samplesPerBlock_(samplesPerBlock), block_(area) {
    if (samplesPerBlock == 0) throw std::invalid_argument("a block has no samples");
}

std::vector<PixelTarget> BlockBackend::inThisBlock(std::span<const PixelTarget> targets) const {
    std::vector<PixelTarget> result;
    for (const PixelTarget& t : targets) {
        if (t.samples <= firstSample()) continue;
        const uint32_t samples = std::min(t.samples - firstSample(), samplesPerBlock_);
        if (block_.pixels[t.pixel].taken() < samples) result.push_back({t.pixel, samples});
    }
    return result;
}

void BlockBackend::sample(std::span<const PixelTarget> targets, Film& film,
                          const PassProgress& progress) {
    const auto goesBeyond = [&](const PixelTarget& t) {
        return t.samples > firstSample() + samplesPerBlock_;
    };
    uint64_t done = 0;
    bool goesOn = true;
    for (;;) {
        uint64_t doneOfBlock = 0;
        const std::vector<PixelTarget> now = inThisBlock(targets);
        if (!now.empty())
            inner_->sample(now, block_, [&](uint64_t samples) {
                doneOfBlock = samples;
                goesOn = (!progress || progress(done + samples)) && goesOn;
                return goesOn;
            });
        done += doneOfBlock;
        if (!goesOn || std::none_of(targets.begin(), targets.end(), goesBeyond)) break;
        beginNextBlock();
    }
    tbb::parallel_for(tbb::blocked_range<size_t>(0, targets.size(), kPixelsAtOnce),
                      [&](const auto& range) {
                          for (size_t i = range.begin(); i != range.end(); ++i)
                              film.pixels[targets[i].pixel] = statisticsOf(targets[i].pixel);
                      });
}

void BlockBackend::beginNextBlock() {
    for (const PixelStatistics& p : block_.pixels)
        if (p.taken() != samplesPerBlock_)
            throw std::logic_error("pixels of a render in blocks have unequal samples");
    sums_.add(block_, firstSample());
    std::ranges::fill(block_.pixels, PixelStatistics{});
    ++blocksDone_;
    inner_->beginAt(firstSample());
}

PixelStatistics BlockBackend::statisticsOf(uint32_t pixel) const {
    ExactStatistics exact = sums_.pixels().empty() ? ExactStatistics{} : sums_.pixels()[pixel];
    exact.add(block_.pixels[pixel], firstSample());
    return exact.statistics();
}

SampleValue BlockBackend::sampleAlone(uint32_t pixel, uint32_t sample) {
    return inner_->sampleAlone(pixel, sample);
}

KeptPixels BlockBackend::save(const Film&, PixelRun run) {
    return inner_->save(block_, run);
}

void BlockBackend::restoreBlocks(std::span<const ExactStatistics> blocks) {
    if (!blocks.empty() && blocks.size() != block_.pixels.size())
        throw std::invalid_argument("the saved film is not of this picture");
    sums_.restore(blocks);
    blocksDone_ = blocks.empty() ? 0 : blocks.front().taken() / samplesPerBlock_;
    inner_->beginAt(firstSample());
}

void BlockBackend::restore(PixelRun run, const KeptPixels& pixels, Film& film) {
    inner_->restore(run, pixels, block_);
    for (uint32_t i = run.first; i < run.first + run.count; ++i)
        film.pixels[i] = statisticsOf(i);
}

} // namespace stromboli

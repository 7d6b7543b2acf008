#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

namespace stromboli {

// --- Bands ---------------------------------------------------------------------------------------

/// Bytes of the host's memory that a render takes for each pixel, at most: film, noise estimate,
/// lists of work, steps of the plan; in blocks: that of the block, and exact sums.
uint64_t hostBytesPerPixel(bool inBlocks = false);

/// The rows of what is rendered, from the top, in bands of about the same height and of at most
/// `pixels` pixels each (at least one row). One band if all of it fits.
std::vector<PictureArea> bandsOf(const PictureArea& area, uint64_t pixels);
/// The rows in `count` bands of about the same height; there are at least as many rows.
std::vector<PictureArea> inBands(const PictureArea& area, uint32_t count);

// --- Blocks of samples ---------------------------------------------------------------------------

/// Blocks of samples by their number, without the last.
struct BlockRange {
    uint32_t first = 0, end = 0;

    bool empty() const { return first == end; }
    auto operator<=>(const BlockRange&) const = default;
};

/// The samples of every pixel, cut into blocks that are added up by themselves, and then to each
/// other, exactly: whoever takes a block gets the same sums.
struct SampleBlocks {
    uint32_t samples = 0;  ///< of a pixel
    uint32_t perBlock = 1; ///< the last block may have fewer

    uint32_t count() const { return (samples + perBlock - 1) / perBlock; }
    /// The first sample of a block, or the number of all if there is no such block.
    uint32_t firstOf(uint32_t block) const {
        return uint32_t(std::min<uint64_t>(uint64_t(block) * perBlock, samples));
    }
    /// Those of share `index`, which counts from 1, of `shares`; there may be none. They follow
    /// each other: so many Sobol points in a row fill the gaps between each other best.
    BlockRange ofShare(uint32_t index, uint32_t shares) const {
        const auto before = [&](uint32_t i) { return uint32_t(uint64_t(count()) * i / shares); };
        return {before(index - 1), before(index)};
    }
};

// --- Adding up block by block --------------------------------------------------------------------

/// The pixels of a film as exact sums over blocks of samples.
class BlockSums {
  public:
    /// Adds a block of all pixels, the first sample of which has this number. Throws SceneError if
    /// a radiance is out of range.
    void add(const Film& block, uint32_t firstSample);

    const std::vector<ExactStatistics>& pixels() const { return pixels_; }
    /// Those of another time.
    void restore(std::span<const ExactStatistics> pixels);

  private:
    std::vector<ExactStatistics> pixels_; ///< empty: no block was added
};

/// Takes samples as another backend does, but adds them up block by block, so that the picture has
/// the bytes that it has when its blocks are taken by several machines. For pictures whose pixels
/// all have the same number of samples.
class BlockBackend final : public Backend {
  public:
    /// inner: has taken no sample yet, of a picture of this area.
    BlockBackend(std::shared_ptr<Backend> inner, const PictureArea& area, uint32_t samplesPerBlock);

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override;
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override;
    RenderCounters counters() const override { return inner_->counters(); }
    /// Saves the pixels of the block under way.
    KeptPixels save(const Film& film, PixelRun run) override;
    std::vector<ExactStatistics> saveBlocks() const override { return sums_.pixels(); }
    void restoreBlocks(std::span<const ExactStatistics> blocks) override;
    void restore(PixelRun run, const KeptPixels& pixels, Film& film) override;

  private:
    uint32_t firstSample() const { return blocksDone_ * samplesPerBlock_; }
    std::vector<PixelTarget> inThisBlock(std::span<const PixelTarget> targets) const;
    void beginNextBlock();
    /// The blocks that are done and the one under way.
    PixelStatistics statisticsOf(uint32_t pixel) const;

    std::shared_ptr<Backend> inner_;
    uint32_t samplesPerBlock_;
    uint32_t blocksDone_ = 0;
    Film block_;     ///< under way
    BlockSums sums_; ///< of the blocks that are done
};

} // namespace stromboli

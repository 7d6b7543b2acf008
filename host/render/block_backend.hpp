#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/sample_blocks.hpp"

#include <memory>
#include <vector>

namespace stromboli {

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
    /// Of the block under way.
    std::vector<PixelSums> save(const Film& film, PixelRun run) override;
    std::vector<ExactStatistics> saveBlocks() const override { return sums_.pixels(); }
    void restoreBlocks(std::span<const ExactStatistics> blocks) override;
    void restore(PixelRun run, std::span<const PixelSums> sums, Film& film) override;

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

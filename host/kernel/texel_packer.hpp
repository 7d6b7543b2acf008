#pragma once

#include "host/kernel/detail_plan.hpp"
#include "host/kernel/rows.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace stromboli {

/// Pictures that some texture of the plan shows, each once, as gpu::TextureUse has them. They are
/// given rows as they are asked for, and packed together at the end.
class TexelPacker {
  public:
    /// rows: the detail buffer, in which texels follow what is there.
    TexelPacker(const Scene& scene, const DetailPlan& plan, RowPages& rows)
        : scene_(scene), plan_(plan), rows_(rows), end_(rows.size()) {}

    /// gpu::TEXELS_PLAIN
    bool isPlain(const Texture& texture) const;
    /// gpu::TEXELS_HALF
    bool isHalf(const Texture& texture) const { return plan_.isHalf(scene_, texture); }

    uint32_t firstRowOf(const Texture& texture);

    /// Of a picture with the alpha of another texture, which is looked up alike.
    uint32_t firstRowOf(const TextureUse& use, const TextureUse& opacity);

    /// Bundles of the same pictures share their rows. Of no pictures: of one white texel.
    uint32_t firstRowOf(const DetailPlan::Bundle& bundle);

    /// Packs all pictures that were asked for.
    void pack();

  private:
    class EdgedTexels;
    using TexelWords = std::array<uint32_t, 2>; ///< of a gathered texture

    /// Rows that are alike to pack: those of a line of texels, from -1 on, or of a whole picture.
    struct Lines {
        size_t firstRow, rowsOfALine;
        int64_t count;
        std::function<void(int64_t first, int64_t end, Row* row)> pack; ///< lines [first, end)
    };
    void append(Lines lines);
    void appendPlain(const std::vector<uint32_t>& words);
    void appendGathered(const DetailPlan::EdgedImage& edged, bool half);
    template <class Texel>
    void appendLines(const TextureImage& image, EdgedTexels at, Texel texel);
    void appendBundle(const DetailPlan::EdgedBundle& bundle, EdgedTexels at, uint32_t width,
                      uint32_t height);
    /// The row of a texel of a bundle, as gpu::TEXELS_BUNDLE describes it.
    Row bundleTexel(const DetailPlan::EdgedBundle& bundle, size_t texel) const;

    const Scene& scene_;
    const DetailPlan& plan_;
    RowPages& rows_;
    size_t end_; ///< of the rows that have been given away
    std::vector<Lines> lines_;
    std::map<DetailPlan::EdgedImage, uint32_t> firstRowOfImage_, firstRowOfPlainImage_;
    std::map<DetailPlan::EdgedBundle, uint32_t> firstRowOfBundle_;
};

} // namespace stromboli

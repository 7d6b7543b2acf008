#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/detail_plan.hpp"
#include "host/kernel/rows.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace stromboli {

// --- Texels --------------------------------------------------------------------------------------

/// Pictures that some texture of the plan shows, each once, as gpu::TextureUse has them.
class TexelPacker {
  public:
    /// rows: the detail buffer, which grows by each picture.
    TexelPacker(const Scene& scene, const DetailPlan& plan, std::vector<Row>& rows)
        : scene_(scene), plan_(plan), rows_(rows) {}

    /// gpu::TEXELS_PLAIN
    bool isPlain(const Texture& texture) const;

    uint32_t firstRowOf(const Texture& texture);

    /// Bundles of the same pictures share their rows. Of no pictures: of one white texel.
    uint32_t firstRowOf(const DetailPlan::Bundle& bundle);

  private:
    class EdgedTexels;
    using TexelWords = std::array<uint32_t, 2>; ///< of a gathered texture

    Row* append(uint64_t rows);
    void packPlain(const std::vector<uint32_t>& words);
    void packGathered(const TextureImage& image, bool srgb, const EdgedTexels& at);
    void packBundle(const DetailPlan::EdgedBundle& bundle, const EdgedTexels& at, uint32_t width,
                    uint32_t height);
    /// The row of a texel of a bundle, as gpu::TEXELS_BUNDLE describes it.
    Row bundleTexel(const DetailPlan::EdgedBundle& bundle, size_t texel) const;

    const Scene& scene_;
    const DetailPlan& plan_;
    std::vector<Row>& rows_;
    std::map<DetailPlan::EdgedImage, uint32_t> firstRowOfImage_, firstRowOfPlainImage_;
    std::map<DetailPlan::EdgedBundle, uint32_t> firstRowOfBundle_;
};

// --- Attributes and textures ---------------------------------------------------------------------

/// What beside parameters and normals the kernel reads (shaders/shared/texture_types.h).
struct DetailRows {
    std::vector<Row> rows;                     ///< the detail buffer: attributes, then texels
    std::vector<std::vector<Row>> ofLights;    ///< of each of the scene's: its picture's TextureUse
    std::vector<std::vector<Row>> ofMaterials; ///< by material: MaterialDetail and TextureUse rows;
                                               ///< empty where no material has any
};

DetailRows packDetails(const Scene& scene, const WideLayout& bvh, const DetailPlan& plan);

/// Rows that one primitive's attributes take.
uint32_t attributeRows(uint32_t attributes);

} // namespace stromboli

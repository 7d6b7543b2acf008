#include "host/kernel/texel_rows.hpp"

#include "shaders/shared/texture_types.h"

namespace stromboli {
namespace {

/// The texel of a picture of n texels that stands for the i-th, i from -1 to n.
uint32_t edged(int64_t i, uint32_t n, Wrap wrap) {
    if (i >= 0 && i < int64_t(n)) return uint32_t(i);
    const bool isFirst = (i < 0) != (wrap == Wrap::Repeat);
    return isFirst ? 0 : n - 1;
}

} // namespace

/// The places of texels in a picture's words, with what is seen beyond its edges.
class TexelPacker::EdgedTexels {
  public:
    EdgedTexels(const TextureImage& image, Wrap wrapU, Wrap wrapV) {
        for (int64_t x = -1; x <= int64_t(image.width); ++x)
            columns_.push_back(edged(x, image.width, wrapU));
        for (int64_t y = -1; y <= int64_t(image.height); ++y)
            lines_.push_back(size_t(edged(y, image.height, wrapV)) * image.width);
    }

    /// From -1 on. Column: place within a line of texels; line: place of its first texel.
    uint32_t column(int64_t x) const { return columns_[size_t(x + 1)]; }
    size_t line(int64_t y) const { return lines_[size_t(y + 1)]; }

  private:
    std::vector<uint32_t> columns_;
    std::vector<size_t> lines_;
};

bool TexelPacker::isPlain(const Texture& texture) const {
    return plan_.plainImages.contains({texture.image, texture.wrapU, texture.wrapV});
}

uint32_t TexelPacker::firstRowOf(const Texture& texture) {
    const TextureImage& image = scene_.images[texture.image];
    const bool plain = isPlain(texture);
    const Wrap wrapU = plain ? Wrap::Repeat : texture.wrapU,
               wrapV = plain ? Wrap::Repeat : texture.wrapV;
    const auto [known, isNew] =
        firstRowOfImage_.try_emplace({texture.image, wrapU, wrapV, plain}, uint32_t(rows_.size()));
    if (!isNew) return known->second;
    if (plain)
        packPlain(image.words);
    else if (image.format == TexelFormat::RgbaHalf)
        packHalves(image, EdgedTexels(image, wrapU, wrapV));
    else
        packWords(image, EdgedTexels(image, wrapU, wrapV));
    return known->second;
}

uint32_t TexelPacker::firstRowOf(const DetailPlan::Bundle& bundle, bool isWide) {
    BundleImages images;
    TextureImage white;
    white.width = white.height = 1;
    white.words = {~0u};
    const TextureImage* size = &white;
    Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
    for (uint32_t i = 0; i < images.size(); ++i) {
        images[i] = kNone;
        if (!bundle[i]) continue;
        const Texture& texture = scene_.textures[bundle[i]->texture];
        images[i] = texture.image;
        size = &scene_.images[texture.image];
        wrapU = texture.wrapU, wrapV = texture.wrapV;
    }
    const auto [known, isNew] =
        firstRowOfBundle_.try_emplace({images, wrapU, wrapV, isWide}, uint32_t(rows_.size()));
    if (!isNew) return known->second;
    packBundle(images, *size, EdgedTexels(*size, wrapU, wrapV), isWide);
    return known->second;
}

Row* TexelPacker::append(uint64_t rows) {
    const size_t first = rows_.size();
    rows_.resize(first + rows);
    return rows_.data() + first;
}

void TexelPacker::packPlain(const std::vector<uint32_t>& words) {
    // Whole rows: of a part of a row, texel buffers read nothing.
    Row* const rows = append((words.size() + 3) / 4);
    for (size_t i = 0; i < words.size(); ++i)
        rows[i / 4][i % 4] = words[i];
}

void TexelPacker::packWords(const TextureImage& image, const EdgedTexels& at) {
    const std::vector<uint32_t>& w = image.words;
    Row* row = append(uint64_t(image.width + 1) * (image.height + 1));
    for (int64_t y = -1; y < int64_t(image.height); ++y) {
        const size_t upper = at.line(y), lower = at.line(y + 1);
        for (int64_t x = -1; x < int64_t(image.width); ++x) {
            const uint32_t left = at.column(x), right = at.column(x + 1);
            *row++ = {w[upper + left], w[upper + right], w[lower + left], w[lower + right]};
        }
    }
}

void TexelPacker::packHalves(const TextureImage& image, const EdgedTexels& at) {
    const std::vector<uint32_t>& w = image.words;
    Row* row = append(uint64_t(image.width + 2) * (image.height + 1));
    for (int64_t y = -1; y < int64_t(image.height); ++y)
        for (int64_t x = -1; x <= int64_t(image.width); ++x) {
            const size_t upper = 2 * (at.line(y) + at.column(x)),
                         lower = 2 * (at.line(y + 1) + at.column(x));
            *row++ = {w[upper], w[upper + 1], w[lower], w[lower + 1]};
        }
}

void TexelPacker::packBundle(const BundleImages& images, const TextureImage& size,
                             const EdgedTexels& at, bool isWide) {
    Row* row = append(uint64_t(size.width + 2) * (size.height + 1) * (isWide ? 2 : 1));
    for (int64_t y = -1; y < int64_t(size.height); ++y)
        for (int64_t x = -1; x <= int64_t(size.width); ++x) {
            const BundleTexel upper = bundleTexel(images, at.line(y) + at.column(x)),
                              lower = bundleTexel(images, at.line(y + 1) + at.column(x));
            *row++ = {upper[0], upper[1], lower[0], lower[1]};
            if (isWide) *row++ = {upper[2], ~0u, lower[2], ~0u};
        }
}

TexelPacker::BundleTexel TexelPacker::bundleTexel(const BundleImages& images, size_t texel) const {
    const auto wordOf = [&](uint32_t slot) {
        return images[slot] == kNone ? ~0u : scene_.images[images[slot]].words[texel];
    };
    constexpr uint32_t kColor = 0xFFFFFF, kAlpha = ~kColor;
    const uint32_t color = wordOf(gpu::TEXTURE_BASE_COLOR),
                   metallicRoughness = wordOf(gpu::TEXTURE_METALLIC_ROUGHNESS);
    return {(color & kColor) | (metallicRoughness << 16 & kAlpha),
            (wordOf(gpu::TEXTURE_NORMAL) & kColor) | (metallicRoughness << 8 & kAlpha),
            (wordOf(gpu::TEXTURE_EMISSION) & kColor) | (color & kAlpha)};
}

} // namespace stromboli

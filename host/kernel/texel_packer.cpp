#include "host/kernel/texel_packer.hpp"

#include "scene/model/srgb.hpp"
#include "shaders/shared/texture_types.h"

#include <glm/gtc/packing.hpp>
#include <tbb/parallel_for.h>

#include <cmath>
#include <utility>

namespace stromboli {

namespace {

/// Numbers of gpu::TextureUse for each byte.
struct ByteTable {
    std::array<uint32_t, 256> fractions, linearFractions, roots;
    ByteTable() {
        for (uint32_t byte = 0; byte < 256; ++byte) {
            const double linear = srgbToLinear(byte / 255.0);
            fractions[byte] = 257 * byte;
            linearFractions[byte] = uint32_t(std::lround(65535 * linear));
            roots[byte] = uint32_t(std::lround(4095 * std::sqrt(linear)));
        }
    }
};

const ByteTable& byteTable() {
    static const ByteTable table;
    return table;
}

uint32_t byteOf(uint32_t word, uint32_t channel) {
    return word >> 8 * channel & 0xFF;
}

/// Of two half floats of [0, 1] the fractions of 65,535.
uint32_t fractionsOfHalves(uint32_t word) {
    const glm::vec2 values = glm::unpackHalf2x16(word);
    return uint32_t(std::lround(65535 * values.x)) | uint32_t(std::lround(65535 * values.y)) << 16;
}

/// The texels of a picture of bytes, or of half floats of [0, 1], as fractions of 65,535, linear.
class Fractions {
  public:
    /// srgb: the bytes of its colours are sRGB.
    Fractions(const TextureImage& image, bool srgb)
        : words_(image.words.data()), isHalf_(image.format == TexelFormat::RgbaHalf),
          color_(srgb ? byteTable().linearFractions : byteTable().fractions) {}

    std::array<uint32_t, 2> texel(size_t i) const {
        if (isHalf_)
            return {fractionsOfHalves(words_[2 * i]), fractionsOfHalves(words_[2 * i + 1])};
        const uint32_t w = words_[i];
        return {color_[byteOf(w, 0)] | color_[byteOf(w, 1)] << 16,
                color_[byteOf(w, 2)] | byteTable().fractions[byteOf(w, 3)] << 16};
    }

  private:
    const uint32_t* words_;
    bool isHalf_;
    const std::array<uint32_t, 256>& color_;
};

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
    return plan_.plainImages.contains(DetailPlan::EdgedImage(scene_, texture));
}

uint32_t TexelPacker::firstRowOf(const Texture& texture) {
    const TextureImage& image = scene_.images[texture.image];
    DetailPlan::EdgedImage key(scene_, texture);
    // Plain texels neither have edges nor are decoded.
    const bool plain = isPlain(texture);
    if (plain) key.wrapU = key.wrapV = Wrap::Repeat, key.srgb = false;
    auto& known = plain ? firstRowOfPlainImage_ : firstRowOfImage_;
    const auto [place, isNew] = known.try_emplace(key, uint32_t(end_));
    if (!isNew) return place->second;
    if (plain)
        appendPlain(image.words);
    else
        appendGathered(key, isHalf(texture));
    return place->second;
}

uint32_t TexelPacker::firstRowOf(const TextureUse& use, const TextureUse& opacity) {
    const DetailPlan::EdgedImage key(scene_, use, opacity);
    const auto [place, isNew] = firstRowOfImage_.try_emplace(key, uint32_t(end_));
    if (isNew) appendGathered(key, false);
    return place->second;
}

uint32_t TexelPacker::firstRowOf(const DetailPlan::Bundle& bundle) {
    const DetailPlan::EdgedBundle edged(scene_, bundle);
    const auto [known, isNew] = firstRowOfBundle_.try_emplace(edged, uint32_t(end_));
    if (!isNew) return known->second;
    TextureImage white;
    white.width = white.height = 1;
    const TextureImage* size = &white;
    for (const uint32_t image : edged.images)
        if (image != edged.kNone) size = &scene_.images[image];
    appendBundle(edged, EdgedTexels(*size, edged.wrapU, edged.wrapV), size->width, size->height);
    return known->second;
}

void TexelPacker::append(Lines lines) {
    end_ += lines.rowsOfALine * size_t(lines.count);
    lines_.push_back(std::move(lines));
}

/// Lines that one thread packs at a time, so that it decodes most texels once, for the rows above
/// them and below.
constexpr int64_t kLinesAtOnce = 16;

void TexelPacker::pack() {
    rows_.resize(end_);
    tbb::parallel_for(size_t(0), lines_.size(), [&](size_t i) {
        const Lines& lines = lines_[i];
        tbb::parallel_for(tbb::blocked_range<int64_t>(0, lines.count, kLinesAtOnce),
                          [&](const tbb::blocked_range<int64_t>& some) {
                              lines.pack(some.begin() - 1, some.end() - 1,
                                         rows_.data() + lines.firstRow +
                                             size_t(some.begin()) * lines.rowsOfALine);
                          });
    });
}

void TexelPacker::appendPlain(const std::vector<uint32_t>& words) {
    // Whole rows: of a part of a row, texel buffers read nothing.
    append({end_, (words.size() + 3) / 4, 1, [&words](int64_t, int64_t, Row* rows) {
                if (!words.empty()) rows[(words.size() - 1) / 4] = Row{};
                for (size_t i = 0; i < words.size(); ++i)
                    rows[i / 4][i % 4] = words[i];
            }});
}

void TexelPacker::appendGathered(const DetailPlan::EdgedImage& edged, bool half) {
    const TextureImage& image = scene_.images[edged.image];
    const EdgedTexels at(image, edged.wrapU, edged.wrapV);
    const Fractions color(image, edged.srgb);
    if (half)
        appendLines(image, at, [&image](size_t i) -> TexelWords {
            return {image.words[2 * i], image.words[2 * i + 1]};
        });
    else if (edged.opacityImage == edged.kNone)
        appendLines(image, at, [color](size_t i) { return color.texel(i); });
    else
        appendLines(image, at,
                    [color,
                     opacity = Fractions(scene_.images[edged.opacityImage], edged.opacityIsSrgb),
                     flip = edged.opacityIsNegative ? 0xFFFFu : 0u](size_t i) -> TexelWords {
                        const TexelWords texel = color.texel(i);
                        const uint32_t alpha = (opacity.texel(i)[0] & 0xFFFF) ^ flip;
                        return {texel[0], (texel[1] & 0xFFFF) | alpha << 16};
                    });
}

template <class Texel>
void TexelPacker::appendLines(const TextureImage& image, EdgedTexels at, Texel texel) {
    append({end_, size_t(image.width) + 2, int64_t(image.height) + 1,
            [&image, texel, at = std::move(at)](int64_t first, int64_t end, Row* row) {
                std::vector<TexelWords> upper(image.width + 2), lower(image.width + 2);
                const auto read = [&](std::vector<TexelWords>& texels, int64_t y) {
                    for (size_t i = 0; i < texels.size(); ++i)
                        texels[i] = texel(at.line(y) + at.column(int64_t(i) - 1));
                };
                read(upper, first);
                for (int64_t y = first; y < end; ++y) {
                    read(lower, y + 1);
                    for (size_t i = 0; i < upper.size(); ++i)
                        *row++ = {upper[i][0], upper[i][1], lower[i][0], lower[i][1]};
                    std::swap(upper, lower);
                }
            }});
}

void TexelPacker::appendBundle(const DetailPlan::EdgedBundle& bundle, EdgedTexels at,
                               uint32_t width, uint32_t height) {
    append({end_, size_t(width) + 2, int64_t(height) + 2,
            [this, bundle, at = std::move(at), width](int64_t first, int64_t end, Row* row) {
                for (int64_t y = first; y < end; ++y)
                    for (int64_t x = -1; x <= int64_t(width); ++x)
                        *row++ = bundleTexel(bundle, at.line(y) + at.column(x));
            }});
}

Row TexelPacker::bundleTexel(const DetailPlan::EdgedBundle& bundle, size_t texel) const {
    const auto wordOf = [&](uint32_t slot) {
        const uint32_t image = bundle.images[slot];
        return image == bundle.kNone ? ~0u : scene_.images[image].words[texel];
    };
    const uint32_t color = wordOf(gpu::TEXTURE_BASE_COLOR),
                   emission = wordOf(gpu::TEXTURE_EMISSION),
                   metallicRoughness = wordOf(gpu::TEXTURE_METALLIC_ROUGHNESS);
    const auto rootOf = [](uint32_t word, uint32_t channel) {
        return byteTable().roots[byteOf(word, channel)];
    };
    const auto packed = [](uint32_t root, uint32_t nextRoot, uint32_t fraction) {
        return root | nextRoot << 12 | fraction << 24;
    };
    return {packed(rootOf(color, 0), rootOf(color, 1), byteOf(metallicRoughness, 1)),
            packed(rootOf(color, 2), rootOf(emission, 0), byteOf(metallicRoughness, 2)),
            packed(rootOf(emission, 1), rootOf(emission, 2), byteOf(color, 3)),
            wordOf(gpu::TEXTURE_NORMAL)};
}

} // namespace stromboli

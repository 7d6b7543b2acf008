#include "scene/images/texture_image.hpp"

#include "host/core/error.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace stromboli::images {
namespace {

constexpr float kLargestHalf = 65504;

void packHalves(const glm::vec4& texel, uint32_t* words) {
    const glm::vec4 inside = glm::clamp(texel, glm::vec4(-kLargestHalf), glm::vec4(kLargestHalf));
    words[0] = glm::packHalf2x16({inside.x, inside.y});
    words[1] = glm::packHalf2x16({inside.z, inside.w});
}

std::vector<uint32_t> wordsOf(const std::vector<uint8_t>& values, const std::string&, bool) {
    std::vector<uint32_t> words(values.size() / 4);
    for (size_t i = 0; i < words.size(); ++i)
        words[i] = uint32_t(values[4 * i]) | uint32_t(values[4 * i + 1]) << 8 |
                   uint32_t(values[4 * i + 2]) << 16 | uint32_t(values[4 * i + 3]) << 24;
    return words;
}

std::vector<uint32_t> wordsOf(const std::vector<uint16_t>& values, const std::string&, bool srgb) {
    std::vector<float> decoded(65536);
    for (size_t i = 0; i < decoded.size(); ++i)
        decoded[i] = float(srgb ? srgbToLinear(double(i) / 65535) : double(i) / 65535);
    std::vector<uint32_t> words(values.size() / 2);
    for (size_t i = 0; i < values.size(); i += 4)
        packHalves({decoded[values[i]], decoded[values[i + 1]], decoded[values[i + 2]],
                    float(values[i + 3]) / 65535},
                   &words[i / 2]);
    return words;
}

std::vector<uint32_t> wordsOf(const std::vector<float>& values, const std::string& name, bool) {
    std::vector<uint32_t> words(values.size() / 2);
    for (size_t i = 0; i < values.size(); i += 4) {
        for (size_t channel = i; channel < i + 4; ++channel)
            if (std::isnan(values[channel]))
                throw SceneError(name, 0, "", fmt::format("texel {} is not a number", i / 4));
        packHalves({values[i], values[i + 1], values[i + 2], values[i + 3]}, &words[i / 2]);
    }
    return words;
}

/// One texel as numbers whose mean has a meaning, and back.
class TexelCodec {
  public:
    TexelCodec(TexelFormat format, bool srgb) : format_(format), srgb_(srgb) {
        for (size_t i = 0; i < light_.size(); ++i)
            light_[i] = srgb ? srgbToLinear(double(i) / 255) : double(i) / 255;
    }

    size_t wordCount() const { return format_ == TexelFormat::Rgba8 ? 1 : 2; }

    glm::dvec4 read(const uint32_t* words) const {
        if (format_ == TexelFormat::RgbaHalf) {
            const glm::vec2 low = glm::unpackHalf2x16(words[0]);
            const glm::vec2 high = glm::unpackHalf2x16(words[1]);
            return {low.x, low.y, high.x, high.y};
        }
        return {light_[*words & 0xFF], light_[*words >> 8 & 0xFF], light_[*words >> 16 & 0xFF],
                double(*words >> 24) / 255};
    }

    void write(const glm::dvec4& texel, uint32_t* words) const {
        if (format_ == TexelFormat::RgbaHalf) return packHalves(texel, words);
        *words = 0;
        for (int channel = 0; channel < 4; ++channel) {
            const double value =
                srgb_ && channel < 3 ? linearToSrgb(texel[channel]) : texel[channel];
            *words |= uint32_t(std::lround(std::clamp(value, 0.0, 1.0) * 255)) << (8 * channel);
        }
    }

  private:
    TexelFormat format_;
    bool srgb_;
    std::array<double, 256> light_;
};

/// Which old texels a new one covers along an axis, from `first` on, and their shares, which add
/// up to 1. A side of odd length is halved to intervals of more than two texels.
struct Cover {
    uint32_t first = 0;
    std::vector<double> shares;
};

std::vector<Cover> coversOf(uint32_t before, uint32_t after) {
    std::vector<Cover> covers(after);
    // In units of 1 / after of an old texel all borders are whole numbers.
    for (uint64_t i = 0; i < after; ++i) {
        const uint64_t from = i * before, to = from + before;
        covers[i].first = uint32_t(from / after);
        for (uint64_t texel = from / after; texel * after < to; ++texel) {
            const uint64_t begin = std::max(from, texel * after);
            const uint64_t end = std::min(to, (texel + 1) * after);
            covers[i].shares.push_back(double(end - begin) / double(before));
        }
    }
    return covers;
}

uint32_t halfOf(uint32_t side) {
    return std::max(side / 2, 1u);
}

TextureImage halved(const TextureImage& image, const TexelCodec& codec) {
    TextureImage half{image.name, halfOf(image.width), halfOf(image.height), image.format, {}};
    const size_t words = codec.wordCount();
    half.words.resize(size_t(half.width) * half.height * words);
    const std::vector<Cover> columns = coversOf(image.width, half.width);
    const std::vector<Cover> rows = coversOf(image.height, half.height);
    for (uint32_t y = 0; y < half.height; ++y)
        for (uint32_t x = 0; x < half.width; ++x) {
            glm::dvec4 mean(0);
            for (size_t j = 0; j < rows[y].shares.size(); ++j)
                for (size_t i = 0; i < columns[x].shares.size(); ++i) {
                    const size_t texel = (rows[y].first + j) * image.width + columns[x].first + i;
                    mean += rows[y].shares[j] * columns[x].shares[i] *
                            codec.read(&image.words[texel * words]);
                }
            codec.write(mean, &half.words[(size_t(y) * half.width + x) * words]);
        }
    return half;
}

} // namespace

TextureImage textureImage(const Picture& picture, const std::string& name, bool srgb) {
    TextureImage image{name, picture.width, picture.height, TexelFormat::RgbaHalf, {}};
    if (std::holds_alternative<std::vector<uint8_t>>(picture.values))
        image.format = TexelFormat::Rgba8;
    image.words =
        std::visit([&](const auto& values) { return wordsOf(values, name, srgb); }, picture.values);
    return image;
}

void shrinkToFit(TextureImage& image, uint32_t largestSide, bool srgb) {
    const TexelCodec codec(image.format, srgb);
    while (image.width > largestSide || image.height > largestSide)
        image = halved(image, codec);
}

} // namespace stromboli::images

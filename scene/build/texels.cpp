#include "scene/build/texels.hpp"

#include "scene/model/srgb.hpp"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>

namespace stromboli::build {
namespace {

double luminance(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.212671, 0.715160, 0.072169)); // Rec. 709
}

/// A texel that holds a value where the layout says.
glm::dvec4 arranged(const glm::dvec3& value, Layout layout) {
    glm::dvec4 texel(1.0);
    switch (layout) {
    case Layout::Color:
        return {value, 1};
    case Layout::Alpha:
        texel.w = luminance(value);
        break;
    case Layout::Red:
    case Layout::Grey:
        texel.x = luminance(value);
        break;
    case Layout::Green:
        texel.y = luminance(value);
        break;
    case Layout::Blue:
        texel.z = luminance(value);
        break;
    case Layout::GreenAndBlue:
        texel.y = texel.z = luminance(value);
        break;
    }
    return texel;
}

void append(std::vector<uint32_t>& words, const glm::dvec4& texel) {
    words.push_back(glm::packHalf2x16(glm::vec2(texel.x, texel.y)));
    words.push_back(glm::packHalf2x16(glm::vec2(texel.z, texel.w)));
}

} // namespace

void appendTexel(std::vector<uint32_t>& words, const glm::dvec3& value, Layout layout) {
    append(words, arranged(value, layout));
}

glm::dvec3 colorAt(const TextureImage& image, size_t i, bool srgb) {
    if (image.format == TexelFormat::RgbaHalf) {
        const glm::vec2 low = glm::unpackHalf2x16(image.words[2 * i]);
        return {low.x, low.y, glm::unpackHalf2x16(image.words[2 * i + 1]).x};
    }
    static const std::array<double, 256> kLinear = [] {
        std::array<double, 256> linear{};
        for (size_t value = 0; value < linear.size(); ++value)
            linear[value] = srgbToLinear(double(value) / 255);
        return linear;
    }();
    glm::dvec3 color;
    for (const int channel : {0, 1, 2}) {
        const size_t value = image.words[i] >> (8 * channel) & 0xFF;
        color[channel] = srgb ? kLinear[value] : double(value) / 255;
    }
    return color;
}

TextureImage rearranged(const TextureImage& image, bool srgb, Layout layout) {
    TextureImage result{image.name, image.width, image.height, TexelFormat::RgbaHalf, {}};
    const size_t count = size_t(image.width) * image.height;
    result.words.reserve(2 * count);
    for (size_t i = 0; i < count; ++i)
        append(result.words, arranged(colorAt(image, i, srgb), layout));
    return result;
}

TextureImage ofMeans(const TextureImage& image, bool srgb) {
    TextureImage result{image.name, image.width, image.height, TexelFormat::RgbaHalf, {}};
    const size_t count = size_t(image.width) * image.height;
    result.words.reserve(2 * count);
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 color = colorAt(image, i, srgb);
        append(result.words, glm::dvec4(glm::dvec3((color.x + color.y + color.z) / 3), 1));
    }
    return result;
}

TextureImage decodedBy(const TextureImage& image, double power) {
    TextureImage result{image.name, image.width, image.height, TexelFormat::RgbaHalf, {}};
    const size_t count = size_t(image.width) * image.height;
    result.words.reserve(2 * count);
    for (size_t i = 0; i < count; ++i)
        append(result.words, glm::dvec4(glm::pow(colorAt(image, i, false), glm::dvec3(power)), 1));
    return result;
}

bool isColored(const TextureImage& image, bool srgb) {
    constexpr double kRounding = 1e-3; // of halfs
    const size_t count = size_t(image.width) * image.height;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 color = colorAt(image, i, srgb);
        const double least = std::min({color.x, color.y, color.z});
        const double most = std::max({color.x, color.y, color.z});
        if (most - least > kRounding * most) return true;
    }
    return false;
}

bool isGrey(const TextureImage& image) {
    return image.format == TexelFormat::Rgba8 &&
           std::ranges::all_of(image.words, [](uint32_t word) {
               return (word & 0xFF) == (word >> 8 & 0xFF) && (word & 0xFF) == (word >> 16 & 0xFF);
           });
}

void makeOpaque(TextureImage& image) {
    if (image.format == TexelFormat::Rgba8)
        for (uint32_t& word : image.words)
            word |= 0xFF000000u;
    else
        for (size_t i = 1; i < image.words.size(); i += 2)
            image.words[i] = glm::packHalf2x16({glm::unpackHalf2x16(image.words[i]).x, 1.0f});
}

void spreadChannel(TextureImage& image, int channel) {
    if (image.format == TexelFormat::Rgba8) {
        for (uint32_t& word : image.words) {
            const uint32_t value = word >> (8 * channel) & 0xFF;
            word = value * 0x010101u | 0xFF000000u;
        }
        return;
    }
    for (size_t i = 0; i < image.words.size(); i += 2) {
        const uint32_t value =
            image.words[i + size_t(channel / 2)] >> (16 * (channel % 2)) & 0xFFFF;
        image.words[i] = value | value << 16;
        image.words[i + 1] = value | image.words[i + 1] >> 16 << 16;
    }
}

} // namespace stromboli::build

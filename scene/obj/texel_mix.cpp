#include "scene/obj/texel_mix.hpp"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::obj {
namespace {

size_t wordsOfTexel(const TextureImage& image) {
    return image.format == TexelFormat::Rgba8 ? 1 : 2;
}

/// The numbers of a texel as the file has them: no transfer function is undone.
glm::vec4 valuesAt(const TextureImage& image, size_t texel) {
    if (image.format == TexelFormat::Rgba8) return glm::unpackUnorm4x8(image.words[texel]);
    const glm::vec2 low = glm::unpackHalf2x16(image.words[2 * texel]);
    const glm::vec2 high = glm::unpackHalf2x16(image.words[2 * texel + 1]);
    return {low, high};
}

float pick(const glm::vec4& values, MapChannel channel) {
    switch (channel) {
    case MapChannel::Red:
        return values.x;
    case MapChannel::Green:
        return values.y;
    case MapChannel::Blue:
        return values.z;
    case MapChannel::Alpha:
        return values.w;
    default: // ITU-R BT.709
        return 0.2126f * values.x + 0.7152f * values.y + 0.0722f * values.z;
    }
}

/// The texel of a picture that lies where texel (x, y) of one of size width x height does.
size_t texelAt(const TextureImage& image, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    const uint64_t column = uint64_t(x) * image.width / width;
    const uint64_t row = uint64_t(y) * image.height / height;
    return size_t(row * image.width + column);
}

float valueAt(const ChannelSource& source, uint32_t x, uint32_t y, const TextureImage& target) {
    if (!source.image) return 1;
    const size_t texel = texelAt(*source.image, x, y, target.width, target.height);
    return std::clamp(pick(valuesAt(*source.image, texel), source.channel), 0.0f, 1.0f);
}

void growTo(TextureImage& target, const TextureImage* image) {
    if (!image) return;
    target.width = std::max(target.width, image->width);
    target.height = std::max(target.height, image->height);
    if (target.name.empty()) target.name = image->name;
}

} // namespace

MapChannel resolvedChannel(const TextureImage& image, MapChannel stated, bool mayBeAlpha) {
    if (stated != MapChannel::Unstated) return stated;
    const size_t count = image.words.size() / wordsOfTexel(image);
    for (size_t texel = 0; mayBeAlpha && texel < count; ++texel)
        if (valuesAt(image, texel).w < 1) return MapChannel::Alpha;
    return MapChannel::Luminance;
}

TextureImage withAlpha(const TextureImage* color, const ChannelSource& alpha) {
    TextureImage mixed;
    growTo(mixed, color);
    growTo(mixed, alpha.image);
    if (color) mixed.format = color->format;
    const bool isHalf = mixed.format == TexelFormat::RgbaHalf;
    mixed.words.reserve(size_t(mixed.width) * mixed.height * wordsOfTexel(mixed));
    for (uint32_t y = 0; y < mixed.height; ++y)
        for (uint32_t x = 0; x < mixed.width; ++x) {
            const float opacity = valueAt(alpha, x, y, mixed);
            const size_t texel = color ? texelAt(*color, x, y, mixed.width, mixed.height) : 0;
            if (isHalf) {
                const uint32_t blue = color->words[2 * texel + 1] & 0xFFFFu;
                mixed.words.push_back(color->words[2 * texel]);
                mixed.words.push_back(blue | uint32_t(glm::packHalf1x16(opacity)) << 16);
            } else {
                const uint32_t rgb = color ? color->words[texel] & 0xFFFFFFu : 0xFFFFFFu;
                mixed.words.push_back(rgb | uint32_t(std::lround(opacity * 255)) << 24);
            }
        }
    return mixed;
}

TextureImage roughnessMetallic(const ChannelSource& roughness, const ChannelSource& metallic) {
    TextureImage mixed;
    growTo(mixed, roughness.image);
    growTo(mixed, metallic.image);
    mixed.words.reserve(size_t(mixed.width) * mixed.height);
    for (uint32_t y = 0; y < mixed.height; ++y)
        for (uint32_t x = 0; x < mixed.width; ++x)
            mixed.words.push_back(glm::packUnorm4x8(
                {1, valueAt(roughness, x, y, mixed), valueAt(metallic, x, y, mixed), 1}));
    return mixed;
}

} // namespace stromboli::obj

#include "scene/gltf/textures.hpp"

#include "host/core/error.hpp"
#include "host/core/system.hpp"
#include "scene/build/file_store.hpp"
#include "scene/gltf/uri.hpp"
#include "scene/images/texture_image.hpp"

#include <fmt/format.h>
#include <glm/packing.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::gltf {
namespace {

constexpr uint64_t kNearest = 9728, kClamp = 33071, kMirror = 33648, kRepeat = 10497;

Wrap wrapOf(const Element& sampler, std::string_view member) {
    const uint64_t stated = sampler.count(member, kRepeat);
    switch (stated) {
    case kClamp:
        return Wrap::Clamp;
    case kMirror:
        return Wrap::Mirror;
    case kRepeat:
        return Wrap::Repeat;
    default:
        sampler.forgive(build::Shortfall::Word, member,
                        fmt::format("is {}, expected 33071, 33648 or 10497", stated));
        return Wrap::Repeat;
    }
}

/// KHR_texture_transform: offset, then rotation, then scale, as products of matrices. The rotation
/// turns coordinates counter-clockwise as the picture is seen, on which v grows downwards.
void applyTransform(const Element& info, TextureUse& use) {
    const std::optional<Element> transform = info.extension("KHR_texture_transform");
    if (!transform) return;
    const auto pair = [&](std::string_view member, const glm::dvec2& otherwise) {
        const std::vector<double> v = transform->numbersOr(member, 2);
        return v.empty() ? otherwise : glm::dvec2(v[0], v[1]);
    };
    const glm::dvec2 offset = pair("offset", {0, 0}), scale = pair("scale", {1, 1});
    const double angle = transform->number("rotation", 0);
    const double c = std::cos(angle), s = std::sin(angle);
    use.uRow = glm::dvec3(scale.x * c, scale.y * s, offset.x);
    use.vRow = glm::dvec3(-scale.x * s, scale.y * c, offset.y);
}

/// Which of the corners' two sets holds TEXCOORD_`set`; nothing if both hold others.
std::optional<uint32_t> placeOf(uint64_t set, UvSets& uvSets) {
    for (uint32_t i = 0; i < 2; ++i)
        if (uvSets.used[i] && uvSets.sets[i] == set) return i;
    for (const uint32_t i :
         set == 1 ? std::array<uint32_t, 2>{1, 0} : std::array<uint32_t, 2>{0, 1})
        if (!uvSets.used[i]) {
            uvSets.used[i] = true;
            uvSets.sets[i] = uint32_t(set);
            return i;
        }
    return std::nullopt;
}

/// Puts 1 - glossiness x alpha where a texture of MetallicRoughness has its roughness.
void makeRoughness(TextureImage& picture, double glossiness) {
    const auto roughness = [&](double alpha) {
        return std::clamp(1 - glossiness * alpha, 0.0, 1.0);
    };
    if (picture.format == TexelFormat::Rgba8) {
        for (uint32_t& texel : picture.words)
            texel = uint32_t(std::lround(255 * roughness((texel >> 24) / 255.0))) << 8 | 0xFF0000FF;
        return;
    }
    for (size_t i = 0; i + 1 < picture.words.size(); i += 2) {
        const double alpha = glm::unpackHalf2x16(picture.words[i + 1]).y;
        picture.words[i] = glm::packHalf2x16(glm::vec2(1, roughness(alpha)));
        picture.words[i + 1] = glm::packHalf2x16(glm::vec2(0, 1));
    }
}

/// Numbers of attributes above this are no texture coordinates that any program writes.
constexpr uint64_t kMostUvSets = 1024;

} // namespace

std::optional<TextureUse> Textures::use(const Element& parent, std::string_view member,
                                        TextureSlot slot, bool srgb, UvSets& uvSets) {
    return use(parent, member, slot, Reading{srgb, std::nullopt}, uvSets);
}

std::optional<TextureUse> Textures::useGlossiness(const Element& parent, std::string_view member,
                                                  double glossiness, UvSets& uvSets) {
    return use(parent, member, TextureSlot::MetallicRoughness, Reading{false, glossiness}, uvSets);
}

std::optional<TextureUse> Textures::use(const Element& parent, std::string_view member,
                                        TextureSlot slot, const Reading& reading, UvSets& uvSets) {
    const std::optional<Element> info = parent.child(member);
    if (!info) return std::nullopt;
    const std::optional<size_t> index = info->index("index", context_.document.size("textures"));
    if (!index) {
        if (!info->has("index"))
            info->forgive(build::Shortfall::Reference, "index", "is not there");
        return std::nullopt;
    }
    const std::optional<uint32_t> number = textureOrNone(*index, reading);
    if (!number) return std::nullopt;
    TextureUse use;
    use.slot = slot;
    use.texture = *number;
    uint64_t set = info->count("texCoord", 0);
    if (const auto transform = info->extension("KHR_texture_transform"))
        set = transform->count("texCoord", set);
    if (set > kMostUvSets) {
        info->forgive(build::Shortfall::Word, "texCoord", fmt::format("is {}", set));
        set = 0;
    }
    const std::optional<uint32_t> place = placeOf(set, uvSets);
    if (!place) {
        context_.report().ignore(
            "textures", "a material looks up pictures by at most two sets of texture coordinates");
        return std::nullopt;
    }
    use.uvSet = *place;
    applyTransform(*info, use);
    return use;
}

/// The picture of a texture: that of an extension that is read, or else the plain one.
std::optional<size_t> Textures::sourceOf(const Element& texture) {
    const size_t count = context_.document.size("images");
    if (const auto webp = texture.extension("EXT_texture_webp"))
        if (const std::optional<size_t> source = webp->index("source", count)) return source;
    if (const std::optional<size_t> source = texture.index("source", count)) return source;
    if (const auto dds = texture.extension("MSFT_texture_dds"))
        if (const std::optional<size_t> source = dds->index("source", count)) return source;
    const bool basis = texture.extension("KHR_texture_basisu").has_value();
    context_.report().ignore("textures", basis ? "pictures in KTX 2 with Basis compression "
                                                 "(KHR_texture_basisu) are not read"
                                               : "they name no picture");
    return std::nullopt;
}

/// Nothing if the texture cannot be read.
std::optional<uint32_t> Textures::textureOrNone(size_t index, const Reading& reading) {
    try {
        return texture(index, reading);
    } catch (const SceneError& error) {
        context_.report().replace(error, build::Shortfall::Picture);
        return std::nullopt;
    }
}

std::optional<uint32_t> Textures::texture(size_t index, const Reading& reading) {
    const auto found = textures_.find({index, reading});
    if (found != textures_.end()) return found->second;
    const Element element = context_.document.at("textures", index);
    std::optional<uint32_t>& number = textures_[{index, reading}];
    const std::optional<size_t> source = sourceOf(element);
    if (!source) return std::nullopt;
    Texture texture;
    const std::optional<uint32_t> picture = image(*source, reading);
    if (!picture) return std::nullopt;
    texture.image = *picture;
    texture.srgb = reading.srgb;
    if (const auto sampler = context_.document.follow(element, "sampler", "samplers")) {
        texture.wrapU = wrapOf(*sampler, "wrapS");
        texture.wrapV = wrapOf(*sampler, "wrapT");
        texture.nearest = sampler->count("magFilter", 0) == kNearest;
    }
    number = context_.builder.addTexture(texture);
    return number;
}

/// Nothing if the picture is not there or cannot be read.
std::optional<uint32_t> Textures::image(size_t index, const Reading& reading) {
    const auto found = images_.find({index, reading});
    if (found != images_.end()) return found->second;
    TextureImage picture;
    try {
        picture = readOnce(index, reading.srgb);
        if (reading.glossiness) makeRoughness(picture, *reading.glossiness);
    } catch (const SceneError& error) {
        context_.report().replace(error, build::Shortfall::Picture);
        return std::nullopt;
    }
    // Bytes are the same whatever they mean; what is decoded or mixed is not.
    const auto other = reading.glossiness
                           ? images_.end()
                           : images_.find({index, Reading{!reading.srgb, std::nullopt}});
    const bool mayBeMixed = context_.selection().largestTexture > 0;
    if (other != images_.end() && !mayBeMixed && picture.format == TexelFormat::Rgba8)
        return images_[{index, reading}] = other->second;
    const uint64_t copies = context_.builder.conventions().kept ? 2 : 1;
    requireRoom(copies * picture.words.size() * sizeof(uint32_t), index);
    return images_[{index, reading}] = context_.builder.addImage(std::move(picture));
}

/// A picture of one colour takes a few bytes in a file, and a file names any number of them.
void Textures::requireRoom(uint64_t bytes, size_t index) {
    bytes_ += bytes;
    const uint64_t most = physicalMemory() / 2;
    if (bytes_ > most)
        context_.document.at("images", index)
            .fail(fmt::format("brings the pictures to {} MiB, more than half of this machine's "
                              "memory; --max-texture N shrinks them",
                              bytes_ >> 20));
}

TextureImage Textures::readOnce(size_t index, bool srgb) {
    build::FileStore* store = context_.builder.conventions().kept.get();
    if (!store) return readToFit(index, srgb);
    return store->picture(fmt::format("{} {}", index, srgb),
                          [&] { return readToFit(index, srgb); });
}

TextureImage Textures::readToFit(size_t index, bool srgb) {
    TextureImage picture = read(index, srgb);
    const uint32_t largest = context_.selection().largestTexture;
    if (largest > 0) images::shrinkToFit(picture, largest, srgb);
    return picture;
}

TextureImage Textures::read(size_t index, bool srgb) {
    const Document& document = context_.document;
    const Element element = document.at("images", index);
    const std::string place = fmt::format("{}: <images[{}]>", document.file(), index);
    if (element.has("uri")) {
        const std::string uri = element.text("uri");
        const std::string bytes = document.bytesOfUri(uri, element);
        const std::string name = fmt::format("{}: {}", place, shortUri(uri));
        return decoded(bytes, name, srgb, element);
    }
    const std::optional<size_t> view = element.index("bufferView", document.size("bufferViews"));
    if (!view) element.fail("has neither 'uri' nor 'bufferView'");
    return decoded(document.bytesOfView(*view), place, srgb, element);
}

TextureImage Textures::decoded(std::string_view bytes, const std::string& name, bool srgb,
                               const Element& at) {
    images::Picture picture = images::decodePicture(bytes, name);
    for (const images::PictureFault& fault : picture.faults)
        context_.report().replace(at.place(), fault.kind, fault.problem);
    return images::textureImage(picture, name, srgb);
}

} // namespace stromboli::gltf

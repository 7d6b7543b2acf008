#include "scene/mitsuba/textures.hpp"

#include "host/core/memory.hpp"
#include "scene/build/read_file.hpp"
#include "scene/images/texture_image.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::mitsuba {
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
    }
    return texel;
}

void append(std::vector<uint32_t>& words, const glm::dvec4& texel) {
    words.push_back(glm::packHalf2x16(glm::vec2(texel.x, texel.y)));
    words.push_back(glm::packHalf2x16(glm::vec2(texel.z, texel.w)));
}

glm::dvec3 colorAt(const TextureImage& image, size_t i, bool srgb) {
    if (image.format == TexelFormat::RgbaHalf) {
        const glm::vec2 low = glm::unpackHalf2x16(image.words[2 * i]);
        return {low.x, low.y, glm::unpackHalf2x16(image.words[2 * i + 1]).x};
    }
    glm::dvec3 color;
    for (const int channel : {0, 1, 2}) {
        const double value = double(image.words[i] >> (8 * channel) & 0xFF) / 255;
        color[channel] = srgb ? srgbToLinear(value) : value;
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

bool isGrey(const TextureImage& image) {
    return image.format == TexelFormat::Rgba8 &&
           std::ranges::all_of(image.words, [](uint32_t word) {
               return (word & 0xFF) == (word >> 8 & 0xFF) && (word & 0xFF) == (word >> 16 & 0xFF);
           });
}

/// Without the alpha that Mitsuba drops.
void makeOpaque(TextureImage& image) {
    if (image.format == TexelFormat::Rgba8)
        for (uint32_t& word : image.words)
            word |= 0xFF000000u;
    else
        for (size_t i = 1; i < image.words.size(); i += 2)
            image.words[i] = glm::packHalf2x16({glm::unpackHalf2x16(image.words[i]).x, 1.0f});
}

Wrap wrapOf(const Plugin& texture) {
    const std::string mode = texture.text("wrap_mode").value_or("repeat");
    if (mode == "repeat") return Wrap::Repeat;
    if (mode == "mirror") return Wrap::Mirror;
    if (mode == "clamp") return Wrap::Clamp;
    texture.fail("wrap_mode", fmt::format("is '{}', expected repeat, mirror or clamp", mode));
}

bool isNearest(const Plugin& texture) {
    const std::string filter = texture.text("filter_type").value_or("bilinear");
    // Those of Mitsuba 0.x look between texels in the same way, and at smaller pictures from afar.
    if (filter == "bilinear" || filter == "ewa" || filter == "trilinear") return false;
    if (filter == "nearest") return true;
    texture.fail("filter_type", fmt::format("is '{}', expected bilinear or nearest", filter));
}

/// Looks up by `to_uv` times the surface's coordinates; those of Mitsuba 0.x are scaled and moved
/// by numbers of their own.
void applyTransform(const Plugin& texture, TextureUse& use) {
    glm::dmat4 m = texture.transform("to_uv");
    const glm::dvec2 scale(texture.number("uscale").value_or(1),
                           texture.number("vscale").value_or(1));
    const glm::dvec2 offset(texture.number("uoffset").value_or(0),
                            texture.number("voffset").value_or(0));
    for (int column = 0; column < 4; ++column)
        for (const int row : {0, 1}) {
            if (column == 3) m[column][row] += offset[row];
            m[column][row] *= scale[row];
        }
    use.uRow = glm::dvec3(m[0][0], m[1][0], m[3][0]);
    use.vRow = glm::dvec3(m[0][1], m[1][1], m[3][1]);
}

} // namespace

void appendTexel(std::vector<uint32_t>& words, const glm::dvec3& value, Layout layout) {
    append(words, arranged(value, layout));
}

Shade Textures::shade(const Plugin& plugin, std::string_view name, ColorOf what,
                      const glm::dvec3& otherwise, Layout layout) {
    if (const std::optional<glm::dvec3> color = colorOf(plugin, name, what))
        return {*color, {}, {}};
    const Plugin* object = plugin.child(name);
    if (!object) return {otherwise, {}, {}};
    if (object->tag != "texture") object->fail("is no texture, expected a colour or a texture");
    return texture(*object, what, layout);
}

glm::uvec2 Textures::sizeOf(const TextureUse& use) const {
    const TextureImage& image = context_.builder.imageOf(use.texture);
    return {image.width, image.height};
}

Shade Textures::texture(const Plugin& texture, ColorOf what, Layout layout) {
    if (texture.type == "bitmap") return bitmap(texture, layout);
    if (texture.type == "checkerboard") return checkerboard(texture, what, layout);
    if (texture.type == "mesh_attribute") return meshAttribute(texture, layout);
    texture.fail(fmt::format("'{}' is no texture that is read, expected bitmap, checkerboard, "
                             "mesh_attribute or uniform",
                             texture.type));
}

Shade Textures::meshAttribute(const Plugin& texture, Layout layout) {
    const std::string name = texture.requireText("name");
    if (!name.starts_with("vertex_") && !name.starts_with("face_"))
        texture.fail("name", fmt::format("is '{}', expected vertex_... or face_...", name));
    const double scale = texture.number("scale").value_or(1);
    texture.requireAllRead();
    TextureUse use;
    use.texture = kFirstPaint + uint32_t(paints_.size());
    use.uvSet = 1;
    paints_.push_back({name, layout});
    return {glm::dvec3(scale), use, name};
}

const Paint* Textures::paintOf(uint32_t texture) const {
    return texture < kFirstPaint ? nullptr : &paints_.at(texture - kFirstPaint);
}

uint32_t Textures::add(TextureImage image, const Plugin& shape) {
    countBytes(image, shape);
    Texture texture;
    texture.image = context_.builder.addImage(std::move(image));
    texture.wrapU = texture.wrapV = Wrap::Clamp;
    return context_.builder.addTexture(texture);
}

void Textures::countBytes(const TextureImage& image, const Plugin& plugin) {
    bytes_ += image.words.size() * sizeof(uint32_t);
    if (bytes_ > physicalMemory() / 2)
        plugin.fail(fmt::format("brings the pictures to {} MiB, more than half of this machine's "
                                "memory; --max-texture N shrinks them",
                                bytes_ >> 20));
}

Shade Textures::bitmap(const Plugin& plugin, Layout layout) {
    const bool raw = plugin.flag("raw").value_or(false) || plugin.number("gamma") == 1.0;
    Texture texture;
    texture.image = image(plugin, raw, layout);
    texture.wrapU = texture.wrapV = wrapOf(plugin);
    texture.nearest = isNearest(plugin);
    texture.srgb = !raw && (layout == Layout::Color || layout == Layout::Grey);
    TextureUse use;
    applyTransform(plugin, use);
    for (const char* unused : {"format", "accel", "max_anisotropy"})
        plugin.skip(unused);
    plugin.requireAllRead();
    use.texture = context_.builder.addTexture(texture);
    return {glm::dvec3(1), use, {}};
}

uint32_t Textures::image(const Plugin& plugin, bool raw, Layout layout) {
    const std::filesystem::path file = context_.document.file(plugin, "filename");
    const auto key = std::tuple(file.string(), raw, layout);
    if (const auto found = images_.find(key); found != images_.end()) return found->second;
    const std::string name = file.string();
    TextureImage image =
        images::textureImage(images::decodePicture(build::readFile(file), name), name, !raw);
    const uint32_t largest = context_.builder.conventions().selection.largestTexture;
    if (largest > 0) images::shrinkToFit(image, largest, !raw);
    if (layout == Layout::Color)
        makeOpaque(image);
    else if (layout != Layout::Grey || !isGrey(image))
        image = rearranged(image, !raw && image.format == TexelFormat::Rgba8, layout);
    countBytes(image, plugin);
    return images_[key] = context_.builder.addImage(std::move(image));
}

/// Two by two texels. As colours, the first and the last are color0; as numbers, for which Mitsuba
/// has another function, the two others are.
Shade Textures::checkerboard(const Plugin& plugin, ColorOf what, Layout layout) {
    const auto colorNamed = [&](const char* name, double otherwise) {
        const std::optional<glm::dvec3> color = colorOf(plugin, name, what);
        if (!color && plugin.child(name)) plugin.fail(name, "is a texture, expected a colour");
        return color.value_or(glm::dvec3(otherwise));
    };
    const glm::dvec3 colors[2] = {colorNamed("color0", 0.4), colorNamed("color1", 0.2)};
    TextureImage image{"checkerboard", 2, 2, TexelFormat::RgbaHalf, {}};
    const int first = layout == Layout::Color ? 0 : 1;
    for (const int which : {first, 1 - first, 1 - first, first})
        append(image.words, arranged(colors[which], layout));
    Texture texture;
    texture.image = context_.builder.addImage(std::move(image));
    texture.nearest = true;
    TextureUse use;
    applyTransform(plugin, use);
    plugin.requireAllRead();
    use.texture = context_.builder.addTexture(texture);
    return {glm::dvec3(1), use, {}};
}

} // namespace stromboli::mitsuba

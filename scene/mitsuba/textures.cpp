#include "scene/mitsuba/textures.hpp"

#include "host/core/system.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/tolerate.hpp"
#include "scene/images/load_texture.hpp"
#include "scene/images/texture_image.hpp"
#include "scene/mitsuba/upgrade.hpp"
#include "scene/mitsuba/volumes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

Wrap wrapOf(const Plugin& texture, const char* parameter, Wrap otherwise) {
    const std::optional<std::string> mode = texture.text(parameter);
    if (!mode) return otherwise;
    if (*mode == "repeat") return Wrap::Repeat;
    if (*mode == "mirror") return Wrap::Mirror;
    if (*mode == "clamp") return Wrap::Clamp;
    texture.replace(build::Shortfall::Model,
                    fmt::format("'{}' is '{}', expected repeat, mirror or clamp", parameter, *mode),
                    "clamp");
    return Wrap::Clamp;
}

bool isNearest(const Plugin& texture) {
    const std::string filter = inSmallLetters(texture.text("filter_type").value_or("bilinear"));
    // Those of Mitsuba 0.x look between texels in the same way, and at smaller pictures from afar.
    if (filter == "bilinear" || filter == "ewa" || filter == "trilinear") return false;
    if (filter == "nearest" || filter == "none") return true;
    texture.replaceParameter("filter_type", build::Shortfall::Word,
                             fmt::format("is '{}', expected bilinear or nearest", filter));
    return false;
}

/// Whether the picture's numbers are linear as they are.
bool isRaw(const Plugin& texture) {
    const bool raw = texture.flag("raw").value_or(false);
    return raw || texture.number("gamma").value_or(0) == 1;
}

/// The power that decodes the picture's numbers; 0: they are linear or sRGB.
double powerOf(const Plugin& texture) {
    const double gamma = isRaw(texture) ? 0 : texture.number("gamma").value_or(0);
    return std::max(gamma, 0.0);
}

/// Whether it holds one number for each texel, which is no height. Mitsuba 0.x takes the mean of
/// the channels for that, Mitsuba 3 the luminance.
bool isOfMeans(const Plugin& texture, Layout layout) {
    return texture.isOld && layout != Layout::Color && layout != Layout::Grey;
}

/// Looks up by `to_uv` times the surface's coordinates; those of Mitsuba 0.x are scaled and then
/// moved by numbers of their own.
void applyTransform(const Plugin& texture, TextureUse& use) {
    glm::dmat4 m = texture.transform("to_uv");
    const double both = texture.number("uvscale").value_or(1);
    const glm::dvec2 scale(texture.number("uscale").value_or(both),
                           texture.number("vscale").value_or(both));
    const glm::dvec2 offset(texture.number("uoffset").value_or(0),
                            texture.number("voffset").value_or(0));
    for (int column = 0; column < 4; ++column)
        for (const int row : {0, 1}) {
            m[column][row] *= scale[row];
            if (column == 3) m[column][row] += offset[row];
        }
    use.uRow = glm::dvec3(m[0][0], m[1][0], m[3][0]);
    use.vRow = glm::dvec3(m[0][1], m[1][1], m[3][1]);
}

/// Which of a texel's numbers a channel is; nothing: there is none of that name.
std::optional<int> placeOfChannel(char channel) {
    const size_t place = std::string_view("rgbaxyzw").find(channel);
    if (place == std::string_view::npos) return std::nullopt;
    return int(place % 4);
}

/// A picture of channels that are alike, or of colours.
template <class Combine>
glm::dvec3 combined(const TextureImage& image, bool srgb, const glm::dvec3& first,
                    Combine combine) {
    glm::dvec3 result = first;
    const size_t count = size_t(image.width) * image.height;
    for (size_t i = 0; i < count; ++i)
        combine(result, build::colorAt(image, i, srgb));
    return result;
}

} // namespace

std::optional<glm::dvec3> firstColorOf(const Plugin& plugin, ColorOf what) {
    for (const std::string& name : plugin.names()) {
        const Value* value = plugin.find(name);
        if (value && (std::holds_alternative<RgbValue>(*value) ||
                      std::holds_alternative<SpectrumValue>(*value)))
            return colorOf(plugin, name, what);
    }
    return std::nullopt;
}

Shade Textures::shade(const Plugin& plugin, std::string_view name, ColorOf what,
                      const glm::dvec3& otherwise, Layout layout) {
    std::optional<glm::dvec3> color;
    build::tolerate(context_.report(), build::Shortfall::Word,
                    [&] { color = colorOf(plugin, name, what); });
    if (color) return {*color, {}, {}};
    const Plugin* object = plugin.child(name);
    if (!object || object->tag == "spectrum") return {otherwise, {}, {}};
    if (object->tag != "texture") {
        object->replace(build::Shortfall::Word, "is no texture, expected a colour or a texture");
        return {otherwise, {}, {}};
    }
    std::optional<Shade> found;
    build::tolerate(context_.report(), build::Shortfall::Picture,
                    [&] { found = texture(*object, what, layout); });
    return found.value_or(Shade{otherwise, {}, {}});
}

std::optional<TextureUse> Textures::complementOf(const TextureUse& use, double factor) {
    if (paintOf(use.texture)) return std::nullopt;
    Texture texture = context_.builder.textureOf(use.texture);
    const TextureImage& image = context_.builder.imageOf(use.texture);
    TextureImage rest{image.name, image.width, image.height, TexelFormat::RgbaHalf, {}};
    const size_t count = size_t(image.width) * image.height;
    for (size_t i = 0; i < count; ++i) {
        const double value = std::clamp(build::colorAt(image, i, texture.srgb).x, 0.0, 1.0);
        build::appendTexel(rest.words, glm::dvec3(1 - factor * value), Layout::Red);
    }
    bytes_ += rest.words.size() * sizeof(uint32_t);
    texture.srgb = false;
    texture.image = context_.builder.addImage(std::move(rest));
    TextureUse other = use;
    other.texture = context_.builder.addTexture(texture);
    return other;
}

glm::uvec2 Textures::sizeOf(const TextureUse& use) const {
    const TextureImage& image = context_.builder.imageOf(use.texture);
    return {image.width, image.height};
}

glm::dvec3 Textures::meanOf(const Shade& shade) const {
    if (!shade.texture || paintOf(shade.texture->texture)) return shade.color;
    const TextureImage& image = context_.builder.imageOf(shade.texture->texture);
    const glm::dvec3 sum =
        combined(image, context_.builder.textureOf(shade.texture->texture).srgb, glm::dvec3(0),
                 [](glm::dvec3& all, const glm::dvec3& one) { all += one; });
    return shade.color * sum / std::max(1.0, double(image.width) * image.height);
}

glm::dvec3 Textures::mostOf(const Shade& shade) const {
    if (!shade.texture || paintOf(shade.texture->texture)) return shade.color;
    const TextureImage& image = context_.builder.imageOf(shade.texture->texture);
    return shade.color *
           combined(image, context_.builder.textureOf(shade.texture->texture).srgb, glm::dvec3(0),
                    [](glm::dvec3& all, const glm::dvec3& one) { all = glm::max(all, one); });
}

std::optional<Shade> Textures::texture(const Plugin& texture, ColorOf what, Layout layout) {
    const std::string& type = texture.type;
    if (type == "bitmap") return bitmap(texture, layout);
    if (type == "checkerboard") return checkerboard(texture, what, layout);
    if (type == "gridtexture") return grid(texture, what, layout);
    if (type == "scale") return scaled(texture, what, layout);
    if (type == "mesh_attribute")
        return meshAttribute(texture, texture.requireText("name"), layout);
    if (type == "vertexcolors") return meshAttribute(texture, "vertex_color", layout);
    if (type == "volume") return meanOfVolume(texture);
    return unknown(texture, what, layout);
}

/// A function of the place in space, where a grid says so: its mean.
Shade Textures::meanOfVolume(const Plugin& plugin) {
    const Plugin* inside = plugin.onlyChildOf("volume");
    if (!inside) plugin.fail("has no volume inside, expected one");
    const Volume volume = readVolume(context_, *inside);
    plugin.requireAllRead();
    if (volume.grid)
        plugin.replace(build::Shortfall::Model, "is a function of the place in space", "its mean");
    return Shade{volume.mean, {}, {}};
}

/// A texture without a counterpart: that inside of it, or a colour of it, is shown.
std::optional<Shade> Textures::unknown(const Plugin& plugin, ColorOf what, Layout layout) {
    const std::string problem =
        fmt::format("'{}' is no texture that is read, expected bitmap, checkerboard, gridtexture, "
                    "scale, mesh_attribute, vertexcolors or uniform",
                    plugin.type);
    const std::vector<const Plugin*> inside = plugin.childrenOf("texture");
    if (!inside.empty()) {
        plugin.replace(build::Shortfall::Model, problem, "the texture inside of it");
        return texture(*inside.front(), what, layout);
    }
    const bool isWire = plugin.type == "wireframe"; // most of which is what lies between its lines
    const std::optional<glm::dvec3> color =
        isWire ? colorOf(plugin, "interior_color", what).value_or(glm::dvec3(0.5))
               : firstColorOf(plugin, what);
    if (!color) plugin.fail(problem);
    plugin.replace(build::Shortfall::Model, problem,
                   isWire ? "the colour between its lines" : "its first colour");
    return Shade{*color, {}, {}};
}

/// Another texture, or a colour, times a factor.
std::optional<Shade> Textures::scaled(const Plugin& plugin, ColorOf what, Layout layout) {
    const glm::dvec3 factor = colorOf(plugin, "scale", what).value_or(glm::dvec3(1));
    const std::vector<const Plugin*> inside = plugin.childrenOf("texture");
    std::optional<Shade> shade;
    if (!inside.empty())
        shade = texture(*inside.front(), what, layout);
    else if (const std::optional<glm::dvec3> color = colorOf(plugin, "value", what))
        shade = Shade{*color, {}, {}};
    else
        plugin.fail("has no texture inside, expected one");
    plugin.requireAllRead();
    if (shade) shade->color *= factor;
    return shade;
}

Shade Textures::meshAttribute(const Plugin& texture, const std::string& name, Layout layout) {
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

std::optional<Shade> Textures::bitmap(const Plugin& plugin, Layout layout) {
    const std::string channel = plugin.text("channel").value_or("");
    std::optional<int> place;
    if (!channel.empty()) place = placeOfChannel(channel.front());
    if (!channel.empty() && !place)
        plugin.replaceParameter("channel", build::Shortfall::Word,
                                fmt::format("is '{}', expected r, g, b or a", channel));
    const bool raw = isRaw(plugin) || place == 3; // alpha is linear
    Texture texture;
    const auto [shownImage, isColored] = image(plugin, raw, layout, place ? channel.front() : '\0');
    const Wrap wrap = wrapOf(plugin, "wrap_mode", Wrap::Repeat);
    texture.wrapU = wrapOf(plugin, "wrap_mode_u", wrap);
    texture.wrapV = wrapOf(plugin, "wrap_mode_v", wrap);
    texture.nearest = isNearest(plugin);
    texture.srgb =
        !raw && powerOf(plugin) == 0 && (layout == Layout::Color || layout == Layout::Grey);
    TextureUse use;
    applyTransform(plugin, use);
    for (const char* unused : {"format", "accel", "max_anisotropy", "cache"})
        plugin.skip(unused);
    plugin.requireAllRead();
    if (!shownImage) return std::nullopt;
    texture.image = *shownImage;
    use.texture = context_.builder.addTexture(texture);
    return Shade{glm::dvec3(1), use, {}, isColored};
}

Textures::Read Textures::image(const Plugin& plugin, bool raw, Layout layout, char channel) {
    const std::filesystem::path file = context_.document.file(plugin, "filename");
    const double power = powerOf(plugin);
    const bool ofMeans = isOfMeans(plugin, layout);
    const auto key = std::tuple(file.string(), raw, layout, channel, power, ofMeans);
    if (const auto found = images_.find(key); found != images_.end()) return found->second;
    const std::string name = file.string();
    const std::string bytes = build::readFile(file);
    std::optional<TextureImage> image = images::loadTexture(
        [&] { return std::string_view(bytes); }, name, !raw, plugin.place, context_.report());
    if (!image) return images_[key] = Read{};
    bool srgb = !raw && image->format == TexelFormat::Rgba8;
    if (power > 0 && !srgb)
        plugin.replaceParameter("gamma", build::Shortfall::Model,
                                "is stated for a picture of more than 8 bits a channel");
    if (channel != '\0') build::spreadChannel(*image, *placeOfChannel(channel));
    const uint32_t largest = context_.builder.conventions().selection.largestTexture;
    if (largest > 0) images::shrinkToFit(*image, largest, !raw);
    if (power > 0 && srgb) {
        *image = build::decodedBy(*image, power);
        srgb = false;
    }
    bool isColored = false;
    if (ofMeans) {
        isColored = build::isColored(*image, srgb);
        *image = build::ofMeans(*image, srgb);
        srgb = false;
    }
    if (layout == Layout::Color)
        build::makeOpaque(*image);
    else if (layout != Layout::Grey || !build::isGrey(*image))
        *image = build::rearranged(*image, srgb, layout);
    countBytes(*image, plugin);
    return images_[key] = Read{context_.builder.addImage(*std::move(image)), isColored};
}

/// A colour of a pattern; of a texture in its place the mean.
glm::dvec3 Textures::colorNamed(const Plugin& pattern, const char* name, ColorOf what,
                                double otherwise, Layout layout) {
    const Shade stated = shade(pattern, name, what, glm::dvec3(otherwise));
    if (stated.texture)
        pattern.replace(build::Shortfall::Model,
                        fmt::format("'{}' is a texture, expected a colour", name), "its mean");
    const glm::dvec3 found = meanOf(stated);
    return isOfMeans(pattern, layout) ? glm::dvec3((found.x + found.y + found.z) / 3) : found;
}

/// A pattern as a picture that repeats.
Shade Textures::shown(const Plugin& plugin, TextureImage image, bool isNearest) {
    Texture texture;
    countBytes(image, plugin);
    texture.image = context_.builder.addImage(std::move(image));
    texture.nearest = isNearest;
    TextureUse use;
    applyTransform(plugin, use);
    plugin.requireAllRead();
    use.texture = context_.builder.addTexture(texture);
    return {glm::dvec3(1), use, {}};
}

/// Two by two texels. As colours, the first and the last are color0; as numbers, for which Mitsuba
/// 3 has another function, the two others are.
Shade Textures::checkerboard(const Plugin& plugin, ColorOf what, Layout layout) {
    const glm::dvec3 colors[2] = {colorNamed(plugin, "color0", what, 0.4, layout),
                                  colorNamed(plugin, "color1", what, 0.2, layout)};
    TextureImage image{"checkerboard", 2, 2, TexelFormat::RgbaHalf, {}};
    const int first = layout == Layout::Color || plugin.isOld ? 0 : 1;
    for (const int which : {first, 1 - first, 1 - first, first})
        build::appendTexel(image.words, colors[which], layout);
    return shown(plugin, std::move(image), true);
}

/// Lines of color1 around whole coordinates, as wide to each side as line_width says. Texels that a
/// line covers in part are mixtures, so that lines have their width in the mean.
Shade Textures::grid(const Plugin& plugin, ColorOf what, Layout layout) {
    const glm::dvec3 ground = colorNamed(plugin, "color0", what, 0.2, layout);
    const glm::dvec3 line = colorNamed(plugin, "color1", what, 0.4, layout);
    const double width = plugin.number("line_width", 0, 0.5).value_or(0.01);
    constexpr int kSide = 512;
    const auto covered = [&](int texel) { // by lines across this axis
        const auto below = [&](double x) { return std::clamp(width * kSide - x, 0.0, 1.0); };
        return std::max(below(texel), below(kSide - 1 - texel));
    };
    TextureImage image{"gridtexture", kSide, kSide, TexelFormat::RgbaHalf, {}};
    image.words.reserve(size_t(2 * kSide) * kSide);
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            const double share = 1 - (1 - covered(row)) * (1 - covered(column));
            build::appendTexel(image.words, glm::mix(ground, line, share), layout);
        }
    return shown(plugin, std::move(image), false);
}

} // namespace stromboli::mitsuba

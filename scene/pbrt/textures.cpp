#include "scene/pbrt/textures.hpp"

#include "host/core/system.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/tolerate.hpp"
#include "scene/images/load_texture.hpp"
#include "scene/images/texture_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace stromboli::pbrt {
namespace {

constexpr uint32_t kMadeSide = 512; ///< of pictures of patterns without texels of their own

Wrap wrapOf(const Parameters& parameters) {
    const std::string wrap = parameters.text("wrap").value_or("repeat");
    if (wrap == "repeat") return Wrap::Repeat;
    if (wrap != "clamp")
        parameters.replace(build::Shortfall::Model,
                           fmt::format("'wrap' is '{}', expected repeat or clamp", wrap), "clamp");
    return Wrap::Clamp;
}

/// A bilinear lookup, t growing upwards.
glm::dvec3 lookUp(const TextureImage& image, bool srgb, Wrap wrap, const glm::dvec2& st) {
    const glm::dvec2 size(image.width, image.height);
    const glm::dvec2 at = glm::dvec2(st.x, 1 - st.y) * size - 0.5;
    const glm::dvec2 below = glm::floor(at), share = at - below;
    const auto place = [&](double i, double count) {
        return wrap == Wrap::Repeat ? size_t(i - count * std::floor(i / count))
                                    : size_t(std::clamp(i, 0.0, count - 1));
    };
    const auto texel = [&](double x, double y) {
        return build::colorAt(image, place(y, size.y) * image.width + place(x, size.x), srgb);
    };
    return glm::mix(glm::mix(texel(below.x, below.y), texel(below.x + 1, below.y), share.x),
                    glm::mix(texel(below.x, below.y + 1), texel(below.x + 1, below.y + 1), share.x),
                    share.y);
}

/// What of a texel a texture of one number is: pbrt-v4 takes the alpha where there is one.
void makeGrey(TextureImage& image, bool srgb, bool isMean, bool& isLinear) {
    const bool hasAlpha =
        isMean && image.format == TexelFormat::Rgba8 &&
        std::ranges::any_of(image.words, [](uint32_t word) { return word >> 24 != 0xFF; });
    if (hasAlpha) {
        build::spreadChannel(image, 3);
        isLinear = true;
        return;
    }
    if (build::isGrey(image)) return;
    TextureImage grey{image.name, image.width, image.height, TexelFormat::RgbaHalf, {}};
    const size_t count = size_t(image.width) * image.height;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 color = build::colorAt(image, i, srgb);
        const double value = isMean ? (color.x + color.y + color.z) / 3 : luminance(color);
        build::appendTexel(grey.words, glm::dvec3(value), build::Layout::Color);
    }
    image = std::move(grey);
    isLinear = true;
}

} // namespace

std::optional<uint32_t> Textures::picture(const Parameters& parameters, const std::string& name,
                                          bool isLinear, Wrap wrap) {
    const std::filesystem::path file = context_.files.find(parameters.place(), name);
    const auto [found, isNew] = pictures_.try_emplace({file.string(), isLinear, wrap});
    if (!isNew) return found->second;
    std::string bytes;
    std::optional<TextureImage> image = images::loadTexture(
        [&] {
            bytes = build::readFile(file);
            return std::string_view(bytes);
        },
        file.string(), !isLinear, parameters.place(), context_.report());
    if (!image) return std::nullopt;
    const uint32_t largest = context_.builder.conventions().selection.largestTexture;
    if (largest > 0) images::shrinkToFit(*image, largest, !isLinear);
    countBytes(*image, parameters.place());
    Texture texture;
    texture.wrapU = texture.wrapV = wrap;
    texture.srgb = !isLinear && image->format == TexelFormat::Rgba8;
    texture.image = context_.builder.addImage(*std::move(image));
    return found->second = context_.builder.addTexture(texture);
}

void Textures::countBytes(const TextureImage& image, const build::FilePlace& where) {
    bytes_ += image.words.size() * sizeof(uint32_t);
    if (bytes_ > physicalMemory() / 2)
        where.fail(fmt::format("the pictures take {} MiB, more than half of this machine's memory; "
                               "--max-texture N shrinks them",
                               bytes_ >> 20));
}

Pattern Textures::imageMap(const Parameters& p, bool isNumber) {
    const std::string name = p.text("filename").value_or("");
    const Wrap wrap = wrapOf(p);
    // pbrt-v3 has a flag; pbrt-v4 the name of an encoding.
    bool isLinear = !p.flag("gamma", true);
    const std::string encoding = p.text("encoding").value_or("sRGB");
    double gamma = 0;
    if (encoding == "linear") isLinear = true;
    if (encoding.starts_with("gamma ")) gamma = std::atof(encoding.c_str() + 6);
    if (gamma > 0) isLinear = true;
    const double scale = p.number("scale", 1, -1e6, 1e6);
    const bool isInverted = p.flag("invert", false);
    const std::string filter = p.text("filter").value_or("bilinear");
    p.skip({"trilinear", "maxanisotropy"});
    const std::optional<uint32_t> shown = picture(p, name, isLinear, wrap);
    Pattern pattern;
    if (!shown) { // there is no picture on the surface
        pattern.color = glm::dvec3(0.5);
        return pattern;
    }
    uint32_t texture = *shown;
    const bool isNearest = filter == "point";
    // Pictures of floats have no encoding. Those of 16 bits are halves here too, and are PNGs.
    const bool isOfFloats = context_.builder.imageOf(texture).format == TexelFormat::RgbaHalf &&
                            !std::string_view(name).ends_with(".png");
    bool isSrgb = context_.builder.textureOf(texture).srgb;
    if (isNumber || isNearest) { // a picture of its own
        Texture other = context_.builder.textureOf(texture);
        TextureImage image = context_.builder.imageOf(texture);
        bool becomesLinear = !isSrgb;
        if (isNumber) makeGrey(image, isSrgb, !context_.isV3(), becomesLinear);
        isSrgb = other.srgb = !becomesLinear;
        other.nearest = isNearest;
        other.image = context_.builder.addImage(std::move(image));
        texture = context_.builder.addTexture(other);
    }
    const auto image = std::make_shared<TextureImage>(context_.builder.imageOf(texture));
    if (isOfFloats) gamma = 0;
    pattern.isConstant = false;
    pattern.color = glm::dvec3(scale);
    pattern.wrap = wrap;
    pattern.texels = {image->width, image->height};
    pattern.isNearest = isNearest;
    const bool isPlain = gamma <= 0 && !isInverted && scale >= 0;
    if (isPlain) pattern.texture = texture;
    pattern.at = [image, isSrgb, wrap, scale, gamma, isInverted](const glm::dvec2& st) {
        glm::dvec3 value = lookUp(*image, isSrgb, wrap, st);
        if (gamma > 0) value = glm::pow(glm::max(value, 0.0), glm::dvec3(gamma));
        value *= scale;
        return isInverted ? glm::max(1.0 - value, 0.0) : value;
    };
    return pattern;
}

/// Squares of one unit, the first one at the origin.
Pattern Textures::checkerboard(const Parameters& p, const TextureTable& table, bool isNumber,
                               const Mapping& mapping) {
    const Pattern one = pattern(p, "tex1", ColorOf::Number, glm::dvec3(1), table, isNumber),
                  two = pattern(p, "tex2", ColorOf::Number, glm::dvec3(0), table, isNumber);
    p.skip({"aamode"});
    if (p.integer("dimension").value_or(2) == 3)
        return meanOfSpace(p, (one.mean() + two.mean()) / 2.0);
    Pattern squares;
    squares.isConstant = false;
    squares.mapping = mapping;
    squares.isNearest = true;
    squares.period = glm::dvec2(2);
    squares.texels = glm::uvec2(2);
    squares.at = [](const glm::dvec2& st) {
        const auto odd = std::fmod(std::floor(st.x) + std::floor(st.y), 2.0) != 0;
        return glm::dvec3(odd ? 1 : 0);
    };
    const Pattern result =
        combined(p, one, two, squares, [](const auto& a, const auto& b, const auto& which) {
            return which.x > 0.5 ? b : a;
        });
    return result;
}

/// Disks in cells of one unit, of which noise says where they are.
Pattern Textures::dots(const Parameters& p, const TextureTable& table, bool isNumber,
                       const Mapping& mapping) {
    const Pattern inside = pattern(p, "inside", ColorOf::Number, glm::dvec3(1), table, isNumber),
                  outside = pattern(p, "outside", ColorOf::Number, glm::dvec3(0), table, isNumber);
    Pattern disks;
    constexpr double kCells = 8;
    disks.isConstant = false;
    disks.mapping = mapping;
    disks.period = glm::dvec2(kCells);
    disks.texels = glm::uvec2(kMadeSide);
    disks.at = [](const glm::dvec2& st) {
        const glm::dvec2 cell = glm::floor(st + 0.5);
        if (!(noise({cell.x + 0.5, cell.y + 0.5, 0.5}) > 0)) return glm::dvec3(0);
        constexpr double kRadius = 0.35, kMostShift = 0.5 - kRadius;
        const glm::dvec2 middle =
            cell + kMostShift * glm::dvec2(noise({cell.x + 1.5, cell.y + 2.8, 0.5}),
                                           noise({cell.x + 4.5, cell.y + 9.8, 0.5}));
        const glm::dvec2 away = st - middle;
        return glm::dvec3(glm::dot(away, away) < kRadius * kRadius ? 1 : 0);
    };
    context_.report().assume("textures 'dots' repeat after 8 cells");
    return combined(p, inside, outside, disks, [](const auto& a, const auto& b, const auto& is) {
        return glm::mix(b, a, is.x);
    });
}

Pattern Textures::bilinear(const Parameters& p, bool isNumber) {
    glm::dvec3 v[4];
    constexpr const char* kNames[] = {"v00", "v01", "v10", "v11"};
    for (size_t i = 0; i < 4; ++i)
        v[i] =
            pattern(p, kNames[i], ColorOf::Number, glm::dvec3(double(i % 2)), {}, isNumber).color;
    Pattern pattern;
    pattern.isConstant = false;
    pattern.wrap = Wrap::Clamp;
    pattern.texels = glm::uvec2(64);
    pattern.at = [a = v[0], b = v[1], c = v[2], d = v[3]](const glm::dvec2& st) {
        return glm::mix(glm::mix(a, b, st.y), glm::mix(c, d, st.y), st.x);
    };
    return pattern;
}

Pattern Textures::combined(const Parameters& p, const Pattern& a, const Pattern& b,
                           const Pattern& c, const Combine& how) {
    Pattern result;
    if (!combine(a, b, c, how, result))
        p.replace(build::Shortfall::Model, "has textures of different mappings inside",
                  "the mean of one of them");
    return result;
}

Pattern Textures::meanOfSpace(const Parameters& p, const glm::dvec3& mean) {
    p.replace(build::Shortfall::Model, "is a function of the place in space", "its mean");
    return Pattern::constant(mean);
}

void Textures::readMapping(const Parameters& p, const glm::dmat4& worldFromTexture,
                           Mapping& mapping) {
    const std::string kind = p.text("mapping").value_or("uv");
    mapping.scale = {p.number("uscale", 1, -1e6, 1e6), p.number("vscale", 1, -1e6, 1e6)};
    mapping.offset = {p.number("udelta", 0, -1e6, 1e6), p.number("vdelta", 0, -1e6, 1e6)};
    mapping.sAxis = p.vector("v1").value_or(mapping.sAxis);
    mapping.tAxis = p.vector("v2").value_or(mapping.tAxis);
    if (kind == "uv") return void(mapping = {Mapping::Kind::Uv, mapping.scale, mapping.offset});
    if (kind == "planar")
        mapping.kind = Mapping::Kind::Planar;
    else if (kind == "spherical" || kind == "cylindrical")
        mapping.kind = kind == "spherical" ? Mapping::Kind::Spherical : Mapping::Kind::Cylindrical;
    else
        return p.replaceParameter("mapping", build::Shortfall::Word,
                                  fmt::format("is '{}', expected uv, planar, spherical or "
                                              "cylindrical",
                                              kind));
    // In pbrt-v3 planes lie in the world, and the height of a cylinder is that of a direction.
    mapping.isOfUnitSphere = context_.isV3();
    if (!context_.isV3() || mapping.kind != Mapping::Kind::Planar)
        mapping.textureFromWorld = glm::inverse(worldFromTexture);
    if (mapping.kind != Mapping::Kind::Planar)
        context_.report().assume(fmt::format("the mapping '{}' of a texture is that of the corners "
                                             "of triangles, linear between them",
                                             kind));
}

PatternPointer Textures::make(const std::string& kind, bool isNumber, const Parameters& p,
                              const TextureTable& table, const glm::dmat4& worldFromTexture) {
    const auto input = [&](std::string_view name, double otherwise) {
        return pattern(p, name, ColorOf::Number, glm::dvec3(otherwise), table, isNumber);
    };
    Pattern result;
    const bool hasMapping = kind != "scale" && kind != "mix" && kind != "directionmix";
    Mapping mapping;
    if (hasMapping) readMapping(p, worldFromTexture, mapping);
    if (kind == "constant") {
        result = input("value", 1);
    } else if (kind == "scale") {
        // pbrt-v4 calls both tex and scale.
        const bool isNew = p.has("tex") || p.has("scale");
        result =
            combined(p, input(isNew ? "tex" : "tex1", 1), input(isNew ? "scale" : "tex2", 1),
                     Pattern(), [](const auto& a, const auto& b, const auto&) { return a * b; });
        // A picture times a colour needs no other picture.
        const Pattern a = input(isNew ? "tex" : "tex1", 1), b = input(isNew ? "scale" : "tex2", 1);
        const Pattern &image = a.texture ? a : b, &factor = a.texture ? b : a;
        const bool isPositive = glm::all(glm::greaterThanEqual(factor.color, glm::dvec3(0)));
        if (image.texture && factor.isConstant && isPositive) {
            result.texture = image.texture;
            result.color = image.color * factor.color;
        }
    } else if (kind == "mix") {
        const Pattern amount = pattern(p, "amount", ColorOf::Number, glm::dvec3(0.5), table, true);
        result = combined(
            p, input("tex1", 0), input("tex2", 1), amount,
            [](const auto& a, const auto& b, const auto& share) { return glm::mix(a, b, share); });
    } else if (kind == "directionmix") {
        p.skip({"dir"});
        p.replace(build::Shortfall::Model, "is a mixture by the direction", "one in equal parts");
        result = combined(p, input("tex1", 0), input("tex2", 1), Pattern(),
                          [](const auto& a, const auto& b, const auto&) { return (a + b) / 2.0; });
    } else if (kind == "imagemap") {
        result = imageMap(p, isNumber);
    } else if (kind == "checkerboard") {
        result = checkerboard(p, table, isNumber, mapping);
    } else if (kind == "dots") {
        result = dots(p, table, isNumber, mapping);
    } else if (kind == "bilerp") {
        result = bilinear(p, isNumber);
    } else if (kind == "uv") {
        result.isConstant = false;
        result.texels = glm::uvec2(kMadeSide);
        result.at = [](const glm::dvec2& st) { return glm::dvec3(st - glm::floor(st), 0); };
    } else if (kind == "fbm" || kind == "windy" || kind == "wrinkled" || kind == "marble") {
        p.skip({"octaves", "roughness", "scale", "variation"});
        // Means over space: fbm has signs, wrinkled sums absolute values, marble is nearly white.
        const double grey = kind == "wrinkled" ? 0.45 : kind == "windy" ? 0.1 : 0;
        result = meanOfSpace(p, kind == "marble" ? glm::dvec3(0.8, 0.8, 0.84) : glm::dvec3(grey));
    } else if (kind == "ptex") {
        p.skip({"filename", "encoding", "gamma", "scale"});
        p.replace(build::Shortfall::Model, "has a picture for each face", "half of the light");
        result = Pattern::constant(glm::dvec3(0.5));
    } else {
        p.place().fail(fmt::format("'{}' is no texture that is read, expected constant, scale, "
                                   "mix, directionmix, imagemap, checkerboard, dots, bilerp, uv, "
                                   "fbm, windy, wrinkled, marble or ptex",
                                   kind));
    }
    // What lies in squares or disks has a mapping of its own.
    const bool isWhole = kind != "checkerboard" && kind != "dots";
    if (isWhole && !result.isConstant && result.mapping == Mapping()) result.mapping = mapping;
    p.reportUnread();
    result.number = ++made_;
    return std::make_shared<const Pattern>(std::move(result));
}

Pattern Textures::pattern(const Parameters& p, std::string_view name, ColorOf what,
                          const glm::dvec3& otherwise, const TextureTable& table, bool isNumber) {
    if (const std::optional<std::string> texture = p.texture(name)) {
        for (const bool number : {isNumber, !isNumber})
            if (const auto found = table.find({number, *texture}); found != table.end())
                return *found->second;
        p.replaceParameter(name, build::Shortfall::Reference,
                           fmt::format("names the texture '{}', which is not there", *texture));
        return Pattern::constant(otherwise);
    }
    return Pattern::constant(colorOf(context_, p, name, what).value_or(otherwise));
}

Shade Textures::shade(const Pattern& pattern, const Remap& remap, build::Layout layout) {
    if (pattern.isConstant) return {remap ? remap(pattern.color) : pattern.color, {}, {}};
    TextureUse use;
    // Rows of pictures run down, t up.
    const Mapping& m = pattern.mapping;
    const bool isByUv = m.kind == Mapping::Kind::Uv;
    const glm::dvec2 scale = (isByUv ? m.scale : glm::dvec2(1)) / pattern.period;
    const glm::dvec2 offset = (isByUv ? m.offset : glm::dvec2(0)) / pattern.period;
    use.uRow = glm::vec3(float(scale.x), 0, float(offset.x));
    use.vRow = glm::vec3(0, float(-scale.y), float(1 - offset.y));
    use.uvSet = isByUv ? 0 : 1;
    Shade shade{glm::dvec3(1), use, isByUv ? std::nullopt : std::optional(m)};
    if (pattern.texture && !remap && layout == build::Layout::Color) {
        shade.color = pattern.color;
        shade.texture->texture = *pattern.texture;
        return shade;
    }
    const uint32_t largest = context_.builder.conventions().selection.largestTexture;
    const glm::uvec2 size =
        glm::clamp(pattern.texels, 1u, largest > 0 ? std::min(largest, 2048u) : 2048u);
    TextureImage image{"pattern", size.x, size.y, TexelFormat::RgbaHalf, {}};
    image.words.reserve(size_t(2 * size.x) * size.y);
    for (uint32_t row = 0; row < size.y; ++row)
        for (uint32_t column = 0; column < size.x; ++column) {
            const glm::dvec2 st =
                pattern.period * glm::dvec2((column + 0.5) / size.x, 1 - (row + 0.5) / size.y);
            const glm::dvec3 value = pattern.at(st);
            build::appendTexel(image.words, remap ? remap(value) : value, layout);
        }
    countBytes(image, {});
    Texture texture;
    texture.wrapU = texture.wrapV = pattern.wrap;
    texture.nearest = pattern.isNearest;
    texture.image = context_.builder.addImage(std::move(image));
    shade.texture->texture = context_.builder.addTexture(texture);
    return shade;
}

} // namespace stromboli::pbrt

#include "scene/mitsuba/nested_bsdfs.hpp"

#include "scene/mitsuba/words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::mitsuba {
namespace {

const TextureUse* opacityTexture(const Material& m) {
    const auto found = std::ranges::find(m.textures, TextureSlot::Opacity, &TextureUse::slot);
    return found == m.textures.end() ? nullptr : &*found;
}

/// The opacity of a mixture, which is there as often as its first material.
double opacityOf(const Material& m) {
    return m.alphaMode == AlphaMode::Opaque ? 1.0 : double(m.opacity);
}

/// A texture of all materials that a mixture is of.
void addTexture(Surface& surface, const TextureUse& use) {
    for (Surface* each = &surface; each; each = each->other.get())
        each->material.textures.push_back(use);
}

bool hasRelief(const Surface& surface) {
    for (const Surface* each = &surface; each; each = each->other.get())
        for (const TextureUse& use : each->material.textures)
            if (use.slot == TextureSlot::Normal || use.slot == TextureSlot::Height) return true;
    return false;
}

/// For the back of a two-sided surface that has a bsdf of its own: its relief stands out there.
void mirrorRelief(Surface& surface) {
    for (Surface* each = &surface; each; each = each->other.get())
        for (TextureUse& use : each->material.textures)
            if (use.slot == TextureSlot::Normal || use.slot == TextureSlot::Height)
                use.scale = -use.scale;
}

/// A surface with another one behind. What is a mixture takes the place of what is none.
Surface withBack(const Plugin& plugin, Surface front, Surface back) {
    std::string problem;
    if (front.other && back.other) problem = "has two bsdfs that are blends, expected one at most";
    if (opacityOf(front.material) != opacityOf(back.material) || opacityTexture(front.material) ||
        opacityTexture(back.material))
        problem = "has masks inside, expected the mask around the two-sided bsdf";
    if (!problem.empty()) {
        plugin.replace(build::Shortfall::Model, problem, "the front on both sides");
        return front;
    }
    mirrorRelief(back);
    OtherPlace place = OtherPlace::Behind;
    if (front.other) {
        std::swap(front, back);
        place = OtherPlace::InFront;
    }
    front.material.otherPlace = place;
    front.material.otherShare = 1;
    front.other = std::make_shared<Surface>(std::move(back));
    return front;
}

/// Lets a surface be there as often as a picture says, or its negative.
void addOpacity(const Plugin& plugin, Material& m, TextureUse picture, bool isNegative) {
    if (opacityTexture(m))
        return plugin.replace(build::Shortfall::Picture,
                              "is a mask over one whose opacity is a texture");
    picture.slot = TextureSlot::Opacity;
    picture.scale = isNegative ? -1 : 1;
    m.alphaMode = AlphaMode::Blend;
    m.textures.push_back(picture);
}

double meanOf(const glm::dvec3& color) {
    return std::clamp((color.x + color.y + color.z) / 3, 0.0, 1.0);
}

/// How Mitsuba shades what a map has turned. Mitsuba 0.x has neither rule: what a turned normal
/// puts on the other side of the surface is black, and nothing else is darker.
void setReliefRules(Surface& surface, const Plugin& plugin) {
    const bool flips = plugin.flag("flip_invalid_normals").value_or(!plugin.isOld);
    const bool shadows = plugin.flag("use_shadowing_function").value_or(!plugin.isOld);
    for (Surface* each = &surface; each; each = each->other.get()) {
        each->material.reliefRule = flips ? ReliefRule::Flip : ReliefRule::Blacken;
        each->material.reliefShadows = shadows;
    }
}

bool isNothing(const Surface& surface) {
    return !surface.other && opacityOf(surface.material) == 0;
}

/// A blend with nothing is a mask: it is there where it is not nothing.
Surface blendWithNothing(const Plugin& plugin, Surface surface,
                         const std::optional<TextureUse>& picture, double weight, bool isSecond) {
    Material& m = surface.material;
    m.opacity = float(opacityOf(m) * (picture ? 1 : isSecond ? weight : 1 - weight));
    m.alphaMode = AlphaMode::Blend;
    if (picture) addOpacity(plugin, m, *picture, !isSecond);
    return surface;
}

/// If either of two surfaces may be there in a share of cases only, the mixture is there in
/// the mean of both shares, and then the second one as often as it is one of those.
void takeMasksOut(Material& first, Material& second, double& weight) {
    const double a = opacityOf(first), b = opacityOf(second);
    if (a == 1 && b == 1) return;
    const double opacity = (1 - weight) * a + weight * b;
    weight = opacity > 0 ? weight * b / opacity : 0;
    first.alphaMode = AlphaMode::Blend;
    first.opacity = float(opacity);
    second.alphaMode = AlphaMode::Opaque;
    second.opacity = 1;
}

/// As many materials as a mixture may be of: each hit may look at all of them.
constexpr size_t kMostParts = 256;

size_t partsOf(const Surface& surface) {
    size_t parts = 0;
    for (const Surface* each = &surface; each; each = each->other.get())
        ++parts;
    return parts;
}

/// What keeps two surfaces from being mixed; empty: nothing does.
std::string mixingProblem(const Surface& first, const Surface& second, bool hasPicture) {
    const bool haveTextures = opacityTexture(first.material) || opacityTexture(second.material);
    const bool areWhole = opacityOf(first.material) == 1 && opacityOf(second.material) == 1;
    if (haveTextures || (hasPicture && !areWhole))
        return "has a mask inside, and a weight or an opacity that is a texture, expected the mask "
               "around the blend";
    if (first.other && (second.other || hasPicture)) // only the other may be a mixture in turn
        return "has a first bsdf that is a blend, which is not supported here";
    if (partsOf(first) + partsOf(second) > kMostParts)
        return fmt::format("is a mixture of more than {} bsdfs", kMostParts);
    return "";
}

/// The BSDFs inside.
std::vector<const Plugin*> atMostTwo(const Plugin& plugin) {
    std::vector<const Plugin*> inside = plugin.childrenOf("bsdf");
    if (inside.empty())
        plugin.fail(fmt::format("has {} bsdfs inside, expected one or two", inside.size()));
    if (inside.size() > 2) {
        plugin.replace(build::Shortfall::Model,
                       fmt::format("has {} bsdfs inside, expected one or two", inside.size()),
                       "the first two");
        inside.resize(2);
    }
    return inside;
}

/// A texture by its name or, where there is none of that name, the one that is there.
const Plugin* textureIn(const Plugin& plugin, const char* name) {
    const std::vector<const Plugin*> all = plugin.childrenOf("texture");
    if (const Plugin* named = plugin.child(name)) return named;
    return all.empty() ? nullptr : all.front();
}

} // namespace

Surface insideOf(Context& context, Textures& textures, const Plugin& plugin) {
    const Plugin* inside = plugin.onlyChildOf("bsdf");
    if (!inside) plugin.fail("has no bsdf inside, expected one");
    return readBsdf(context, textures, *inside);
}

Surface mixed(const Plugin& plugin, Surface first, Surface second, double weight,
              const std::optional<TextureUse>& picture) {
    if (isNothing(first)) return blendWithNothing(plugin, std::move(second), picture, weight, true);
    if (isNothing(second))
        return blendWithNothing(plugin, std::move(first), picture, weight, false);
    if (const std::string problem = mixingProblem(first, second, picture.has_value());
        !problem.empty()) {
        plugin.replace(build::Shortfall::Model, problem, "that of both with the larger share");
        return weight > 0.5 ? second : first;
    }
    takeMasksOut(first.material, second.material, weight);
    if (first.other) {
        std::swap(first, second);
        std::swap(first.material.alphaMode, second.material.alphaMode);
        std::swap(first.material.opacity, second.material.opacity);
        weight = 1 - weight;
    }
    if (picture) {
        TextureUse use = *picture;
        use.slot = TextureSlot::BlendShare;
        first.material.textures.push_back(use);
    }
    first.material.otherShare = float(weight);
    first.other = std::make_shared<Surface>(std::move(second));
    return first;
}

Surface twoSided(Context& context, Textures& textures, const Plugin& plugin) {
    const std::vector<const Plugin*> inside = atMostTwo(plugin);
    plugin.requireAllRead();
    Surface surface = readBsdf(context, textures, *inside.front());
    if (inside.back() != inside.front())
        surface = withBack(plugin, std::move(surface), readBsdf(context, textures, *inside.back()));
    // Mitsuba turns directions behind a surface to its front by their cosine alone.
    const bool mirrors = inside.back() == inside.front() && hasRelief(surface);
    for (Surface* each = &surface; each; each = each->other.get()) {
        each->material.isBlackBehind = false;
        each->material.mirrorsReliefBehind = mirrors;
    }
    return surface;
}

Surface mask(Context& context, Textures& textures, const Plugin& plugin) {
    Surface surface = insideOf(context, textures, plugin);
    Material& m = surface.material;
    // Where its picture cannot be shown, a surface is there.
    const glm::dvec3 otherwise(plugin.child("opacity") ? 1.0 : 0.5);
    const Shade opacity =
        textures.shade(plugin, "opacity", ColorOf::Reflectance, otherwise, Layout::Red);
    const glm::dvec3& color = opacity.color;
    if (opacity.isColored || color.x != color.y || color.y != color.z)
        plugin.replaceParameter("opacity", build::Shortfall::Model,
                                "differs between red, green and blue, expected one number");
    m.opacity = float(opacityOf(m) * meanOf(color));
    m.alphaMode = AlphaMode::Blend;
    if (opacity.texture) addOpacity(plugin, m, *opacity.texture, false);
    plugin.requireAllRead();
    return surface;
}

Surface normalMap(Context& context, Textures& textures, const Plugin& plugin) {
    Surface surface = insideOf(context, textures, plugin);
    const Plugin* normals = textureIn(plugin, "normalmap");
    std::optional<Shade> shade;
    if (normals && !hasRelief(surface))
        shade = textures.texture(*normals, ColorOf::Reflectance, Layout::Color);
    if (shade && shade->texture && shade->attribute.empty()) {
        TextureUse use = *shade->texture;
        use.slot = TextureSlot::Normal;
        addTexture(surface, use);
    } else if (!normals || shade || hasRelief(surface)) {
        plugin.replace(build::Shortfall::Picture,
                       !normals ? "has no texture 'normalmap'"
                       : shade  ? "has a texture 'normalmap' that is no picture"
                                : "is a map of normals over another one, which is not supported");
    }
    setReliefRules(surface, plugin);
    plugin.requireAllRead();
    return surface;
}

Surface bumpMap(Context& context, Textures& textures, const Plugin& plugin) {
    Surface surface = insideOf(context, textures, plugin);
    const Plugin* heights = plugin.onlyChildOf("texture");
    std::optional<Shade> shade;
    if (heights && !hasRelief(surface))
        shade = textures.texture(*heights, ColorOf::Reflectance, Layout::Grey);
    const double scale = plugin.number("scale").value_or(1);
    if (shade && shade->texture && shade->attribute.empty()) {
        TextureUse use = *shade->texture;
        use.slot = TextureSlot::Height;
        use.scale = float(scale * shade->color.x);
        addTexture(surface, use);
    } else if (!heights || shade || hasRelief(surface)) {
        plugin.replace(build::Shortfall::Picture,
                       !heights ? "has no texture inside, expected one of heights"
                       : shade  ? "has a texture that is no picture, expected one of heights"
                                : "is a bump map over another map of normals, which is not "
                                  "supported");
    }
    setReliefRules(surface, plugin);
    plugin.requireAllRead();
    return surface;
}

Surface blend(Context& context, Textures& textures, const Plugin& plugin) {
    const std::vector<const Plugin*> inside = atMostTwo(plugin);
    Surface first = readBsdf(context, textures, *inside.front());
    if (inside.size() == 1) {
        plugin.replace(build::Shortfall::Model, "has 1 bsdfs inside, expected two", "that one");
        return first;
    }
    Surface second = readBsdf(context, textures, *inside.back());
    const Shade share =
        textures.shade(plugin, "weight", ColorOf::Reflectance, glm::dvec3(0.5), Layout::Red);
    plugin.requireAllRead();
    double weight = meanOf(share.color);
    std::optional<TextureUse> picture = share.texture;
    // Where the share is a picture, only the second one may be a mixture in its turn.
    if (picture && first.other && !second.other && !isNothing(second))
        if (const auto rest = textures.complementOf(*picture, weight)) {
            std::swap(first, second);
            picture = rest;
            weight = 1;
        }
    return mixed(plugin, std::move(first), std::move(second), weight, picture);
}

Surface mixture(Context& context, Textures& textures, const Plugin& plugin) {
    const std::vector<const Plugin*> inside = plugin.childrenOf("bsdf");
    std::vector<double> weights = numbersOf(plugin.place, plugin.requireText("weights"));
    if (inside.empty()) plugin.fail("has no bsdfs inside, expected one for each weight");
    if (weights.size() != inside.size())
        plugin.replaceParameter(
            "weights", build::Shortfall::Number,
            fmt::format("has {} numbers for {} bsdfs", weights.size(), inside.size()));
    weights.resize(inside.size(), 0);
    for (double& weight : weights)
        weight = std::max(weight, 0.0);
    plugin.requireAllRead();
    // From the last one on: each comes in the place of those behind it in its share of all that is
    // there so far. What the weights leave open reflects nothing.
    double sum = 0;
    for (const double weight : weights)
        sum += weight;
    Surface black;
    black.material.albedo = glm::vec3(0);
    black.material.isBlackBehind = true;
    double rest = std::max(1 - sum, 0.0);
    constexpr double kChance = 1e-6; // files carry a few digits
    std::optional<Surface> all;
    if (rest > kChance || !(sum > 0))
        all = black;
    else
        rest = 0;
    for (size_t i = inside.size(); i-- > 0;) {
        if (!(weights[i] > 0)) continue;
        Surface one = readBsdf(context, textures, *inside[i]);
        all = all ? mixed(plugin, std::move(one), *std::move(all), rest / (rest + weights[i]), {})
                  : std::move(one);
        rest += weights[i];
    }
    return *std::move(all);
}

} // namespace stromboli::mitsuba

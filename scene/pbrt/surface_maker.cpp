#include "scene/pbrt/surface_maker.hpp"

#include "scene/build/tolerate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::pbrt {
namespace {

constexpr size_t kMostMixtures = 64; ///< of mixtures in mixtures

/// Makes all that a material scatters so many times stronger.
void strengthen(Material& m, float factor) {
    m.reflectance *= factor;
    if (m.kind == MaterialKind::Diffuse) m.albedo *= factor;
    if (m.kind == MaterialKind::Burley) m.burley.baseColor *= factor;
    m.transmittance *= factor;
}

} // namespace

Surface SurfaceMaker::make() {
    Surface surface;
    surface.material.name = statement.kind;
    const std::string& kind = statement.kind;
    if (kind == "interface" || kind == "none" || kind.empty()) {
        surface = interface();
    } else if (kind == "mix") {
        surface = mix();
    } else {
        const bool isV3 = context.isV3();
        const bool isKnown = isV3 ? makeV3(*this, surface) || makeV4(*this, surface)
                                  : makeV4(*this, surface) || makeV3(*this, surface);
        if (!isKnown)
            parameters.place().fail(fmt::format("'{}' is no material that is read", kind));
    }
    addRelief(surface);
    parameters.skip({"type"});
    parameters.reportUnread();
    return surface;
}

Pattern SurfaceMaker::pattern(std::string_view name, const glm::dvec3& otherwise, ColorOf what,
                              bool isNumber) const {
    return textures_.pattern(parameters, name, what, otherwise, *names_.textures, isNumber);
}

void SurfaceMaker::color(Surface& surface, const Pattern& pattern, glm::vec3& where,
                         TextureSlot slot, std::string_view name) const {
    const Shade shade = textures_.shade(pattern);
    // A factor of a picture may be more than 1; pictures are clamped with it.
    where = shade.texture ? glm::vec3(glm::max(shade.color, 0.0))
                          : context.builder.reflectedFraction(name, glm::vec3(shade.color));
    if (!shade.texture) return;
    if (shade.mapping) surface.mapping = shade.mapping;
    TextureUse use = *shade.texture;
    use.slot = slot;
    surface.material.textures.push_back(use);
}

glm::vec3 SurfaceMaker::plainColor(std::string_view name, const glm::dvec3& otherwise) const {
    const Pattern all = pattern(name, otherwise);
    if (!all.isConstant)
        parameters.replace(build::Shortfall::Model,
                           fmt::format("'{}' is a texture, expected one colour", name), "its mean");
    return context.builder.reflectedFraction(name, glm::vec3(all.mean()));
}

double SurfaceMaker::number(std::string_view name, double otherwise, double least,
                            double most) const {
    const Pattern all = pattern(name, glm::dvec3(otherwise), ColorOf::Number, true);
    if (!all.isConstant)
        parameters.replace(build::Shortfall::Model,
                           fmt::format("'{}' is a texture, expected one number", name), "its mean");
    const double value = all.mean().x;
    if (!(value >= least && value <= most))
        parameters.replaceParameter(name, build::Shortfall::Number,
                                    fmt::format("is {}, expected {} to {}", value, least, most));
    return std::clamp(std::isnan(value) ? otherwise : value, least, most);
}

float SurfaceMaker::fraction(Surface& surface, std::string_view name, double otherwise,
                             TextureSlot slot, build::Layout layout) const {
    const Pattern all = pattern(name, glm::dvec3(otherwise), ColorOf::Number, true);
    if (all.isConstant) return float(number(name, otherwise, 0, 1));
    const Shade shade = textures_.shade(
        all, [](const glm::dvec3& v) { return glm::clamp(v, 0.0, 1.0); }, layout);
    if (shade.mapping) surface.mapping = shade.mapping;
    TextureUse use = *shade.texture;
    use.slot = slot;
    surface.material.textures.push_back(use);
    return 1;
}

/// pbrt-v3's polynomial of the logarithm, and pbrt-v4's root.
double SurfaceMaker::alphaOf(double roughness, bool isRemapped) const {
    double alpha = std::max(roughness, 0.0);
    if (isRemapped && context.isV3()) {
        const double x = std::log(std::max(roughness, 1e-3));
        alpha = 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
    } else if (isRemapped) {
        alpha = std::sqrt(alpha);
    }
    constexpr double kSmooth = 1e-3; // below it pbrt-v4 has a plane
    return !context.isV3() && alpha < kSmooth ? 0 : std::min(alpha, 1e3);
}

void SurfaceMaker::facets(Surface& surface, const std::string& prefix, double otherwise,
                          bool mayHaveTextures) const {
    Facets& facets = surface.material.facets;
    facets.distribution = FacetDistribution::Ggx;
    facets.masking = FacetMasking::Correlated;
    const bool isRemapped = parameters.flag("remaproughness", true);
    const std::string names[2] = {prefix + "uroughness", prefix + "vroughness"};
    const std::string whole = prefix + "roughness";
    if (parameters.has(whole) && !parameters.texture(whole))
        otherwise = number(whole, otherwise, 0, 1e3);
    Pattern roughness[2];
    for (int axis = 0; axis < 2; ++axis) {
        const std::string& name = parameters.has(names[axis]) ? names[axis] : whole;
        roughness[axis] = pattern(name, glm::dvec3(otherwise), ColorOf::Number, true);
    }
    const bool areConstant = roughness[0].isConstant && roughness[1].isConstant;
    if (areConstant || !mayHaveTextures) {
        for (int axis = 0; axis < 2; ++axis)
            facets.alpha[axis] = float(alphaOf(roughness[axis].mean().x, isRemapped));
        if (!areConstant)
            parameters.replace(build::Shortfall::Model,
                               "the roughness is a texture, expected one number", "its mean");
        return;
    }
    Pattern both;
    combine(
        roughness[0], roughness[1], Pattern(),
        [this, isRemapped](const auto& u, const auto& v, const auto&) {
            return glm::dvec3(1, alphaOf(u.x, isRemapped), alphaOf(v.x, isRemapped));
        },
        both);
    const Shade shade = textures_.shade(both);
    facets.alpha = glm::vec2(1);
    if (shade.mapping) surface.mapping = shade.mapping;
    TextureUse use = *shade.texture;
    use.slot = TextureSlot::MetallicRoughness;
    surface.material.textures.push_back(use);
}

void SurfaceMaker::say(const std::string& instead) const {
    parameters.replace(build::Shortfall::Model,
                       fmt::format("'{}' is no material that exists here", statement.kind),
                       fmt::format("of material '{}' {}", statement.kind, instead));
}

Surface SurfaceMaker::interface() const {
    Surface surface;
    surface.material.name = "interface";
    surface.material.albedo = glm::vec3(0);
    surface.material.alphaMode = AlphaMode::Blend;
    surface.material.opacity = 0;
    return surface;
}

Surface SurfaceMaker::empty(MaterialKind kind) const {
    Surface surface;
    surface.material.name = statement.kind;
    surface.material.kind = kind;
    return surface;
}

Surface SurfaceMaker::replaced(std::string_view kind) const {
    say(std::string(kind));
    Surface surface;
    surface.material = build::greyMaterial();
    return surface;
}

Surface SurfaceMaker::sum(std::vector<Lobe> lobes) const {
    std::erase_if(lobes, [](const Lobe& lobe) { return !(lobe.most > 0); });
    if (lobes.empty()) {
        Surface black;
        black.material.albedo = glm::vec3(0);
        return black;
    }
    // Interfaces reflect little but at grazing angles: smaller shares have less noise. What is
    // diffuse must not get more than all light in its share.
    constexpr double kGlossyShare = 0.3, kLeastShare = 0.02;
    double diffuse = 0, glossy = 0;
    for (const Lobe& lobe : lobes)
        (lobe.isGlossy ? glossy : diffuse) += lobe.most;
    const double scale = std::min(kGlossyShare, glossy > 0 ? (1 - diffuse) / glossy : 1.0);
    std::vector<double> shares;
    double all = 0;
    for (const Lobe& lobe : lobes) {
        shares.push_back(lobe.isGlossy ? std::max(scale * lobe.most, kLeastShare) : lobe.most);
        all += shares.back();
    }
    std::optional<Surface> result;
    double rest = 0; // of the shares that are in the result
    for (size_t i = lobes.size(); i-- > 0;) {
        Surface next = std::move(lobes[i].surface);
        strengthen(next.material, float(all / shares[i]));
        if (result) {
            next.material.otherShare = float(rest / (rest + shares[i]));
            next.other = std::make_shared<Surface>(*std::move(result));
            if (!next.mapping) next.mapping = next.other->mapping;
        }
        rest += shares[i];
        result = std::move(next);
    }
    return *result;
}

Surface SurfaceMaker::diffuseTransmitter(const Pattern& transmitted) const {
    Surface surface = empty(MaterialKind::Burley);
    Material& m = surface.material;
    m.burley.isThin = true;
    m.burley.ior = 1;
    m.burley.roughness = 1;
    m.burley.diffuseTransmission = 1;
    color(surface, transmitted, m.burley.baseColor, TextureSlot::BaseColor, "transmittance");
    return surface;
}

/// Two materials by their names. In pbrt-v3 `amount` is the first one's share, in pbrt-v4 the
/// second one's.
Surface SurfaceMaker::mix() const {
    std::string names[2];
    if (const Parameter* list = parameters.find("materials"); list && list->words.size() >= 2) {
        names[0] = list->words[0];
        names[1] = list->words[1];
    } else {
        names[0] = parameters.text("namedmaterial1").value_or("");
        names[1] = parameters.text("namedmaterial2").value_or("");
    }
    const Pattern amount = pattern("amount", glm::dvec3(0.5), ColorOf::Number, true);
    if (depth_ > kMostMixtures)
        parameters.place().fail(fmt::format("is in more than {} mixtures", kMostMixtures));
    Surface parts[2];
    for (int i = 0; i < 2; ++i) {
        if (names[i] == "interface" && !names_.materials->contains(names[i])) {
            parts[i] = interface();
            continue;
        }
        const auto found = names_.materials->find(names[i]);
        if (found == names_.materials->end())
            parameters.place().fail(
                fmt::format("names the material '{}', which is not there", names[i]));
        parts[i] = SurfaceMaker(context, textures_, *found->second, ofScene_, depth_ + 1).make();
    }
    const bool isFirst = context.isV3();
    Remap share = [isFirst](const glm::dvec3& v) {
        const glm::dvec3 inside = glm::clamp(v, 0.0, 1.0);
        return isFirst ? 1.0 - inside : inside;
    };
    const auto isMask = [](const Surface& s) { return s.material.alphaMode != AlphaMode::Opaque; };
    // Only the second one may be a mixture or a mask in its turn.
    if (parts[0].other || isMask(parts[0])) {
        std::swap(parts[0], parts[1]);
        share = [share](const glm::dvec3& v) { return 1.0 - share(v); };
    }
    Surface &one = parts[0], &two = parts[1];
    const bool isPossible = !one.other && !isMask(one);
    const bool isNothing = isMask(two) && two.material.opacity <= 0 && !two.other;
    const Shade shade = textures_.shade(amount, share, build::Layout::Red);
    const auto add = [&](TextureSlot slot, float scale) {
        if (!shade.texture) return;
        if (shade.mapping) one.mapping = shade.mapping;
        TextureUse use = *shade.texture;
        use.slot = slot;
        use.scale = scale;
        one.material.textures.push_back(use);
    };
    if (isPossible && isNothing) { // a mask
        one.material.alphaMode = AlphaMode::Blend;
        one.material.opacity = shade.texture ? 1.0f : float(1 - shade.color.x);
        add(TextureSlot::Opacity, -1);
        return std::move(one);
    }
    if (!isPossible || isMask(two)) {
        parameters.replace(build::Shortfall::Model, "has mixtures or masks inside",
                           "the material with the larger share");
        return share(amount.mean()).x > 0.5 ? two : one;
    }
    one.material.otherShare = shade.texture ? 1.0f : float(shade.color.x);
    add(TextureSlot::BlendShare, 1);
    one.other = std::make_shared<Surface>(std::move(two));
    if (!one.mapping) one.mapping = one.other->mapping;
    return std::move(one);
}

/// Bumps and normal maps, which all parts of a mixture have.
void SurfaceMaker::addRelief(Surface& surface) const {
    for (const char* name : {"displacement", "bumpmap"}) {
        if (!parameters.has(name)) continue;
        const Pattern heights = pattern(name, glm::dvec3(0), ColorOf::Number, true);
        const Shade shade = textures_.shade(heights, nullptr, build::Layout::Color);
        if (!shade.texture) continue;
        if (shade.mapping) {
            parameters.replaceParameter(name, build::Shortfall::Model,
                                        "has no mapping by uv, expected one");
            continue;
        }
        TextureUse use = *shade.texture;
        use.slot = TextureSlot::Height;
        use.scale = float(shade.color.x);
        surface.each([&](Material& m) { m.textures.push_back(use); });
    }
    const std::optional<std::string> map = parameters.text("normalmap");
    if (!map) return;
    std::optional<uint32_t> texture;
    build::tolerate(context.report(), build::Shortfall::Picture,
                    [&] { texture = textures_.picture(parameters, *map, true, Wrap::Repeat); });
    if (!texture) return;
    TextureUse use;
    use.slot = TextureSlot::Normal;
    use.texture = *texture;
    use.vRow = glm::vec3(0, -1, 1);
    surface.each([&](Material& m) { m.textures.push_back(use); });
}

} // namespace stromboli::pbrt

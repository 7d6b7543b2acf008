#include "scene/collada/effects.hpp"

#include "scene/collada/cgl_dialect.hpp"
#include "scene/collada/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace stromboli::collada {
namespace {

const glm::vec3 kMidGrey(0.5f);
constexpr const char* kNoParameter = "the parameter counts as absent";

enum class ChannelKind { Absent, Numbers, Texture };

/// One parameter of a shading model, such as <diffuse>.
struct Channel {
    ChannelKind kind = ChannelKind::Absent;
    const Element* numbers = nullptr;
    const Element* texture = nullptr; ///< <texture>, or the <newparam> of a sampler
};

/// What a `<param ref="...">` stands for.
Channel resolveParameter(const Context& context, const Scope& scope, const Element& param) {
    const std::string sid = context.document.requireAttribute(param, "ref");
    const Element* parameter = findParameter(scope, sid.c_str());
    if (!parameter) {
        context.document.forgive(
            param, fmt::format("ref=\"{}\": the effect has no <newparam> with this sid", sid),
            kNoParameter);
        return {};
    }
    for (const char* type : {"float", "float3", "float4"})
        if (const Element* value = parameter->FirstChildElement(type))
            return {ChannelKind::Numbers, value, nullptr};
    return {ChannelKind::Texture, nullptr, parameter};
}

Channel readChannel(const Context& context, const Scope& scope, const Element& model,
                    const char* name) {
    const Element* channel = model.FirstChildElement(name);
    if (!channel) return {};
    if (const Element* param = channel->FirstChildElement("param"))
        return resolveParameter(context, scope, *param);
    if (const Element* texture = channel->FirstChildElement("texture"))
        return {ChannelKind::Texture, nullptr, texture};
    for (const char* type : {"color", "float"})
        if (const Element* numbers = channel->FirstChildElement(type))
            return {ChannelKind::Numbers, numbers, nullptr};
    context.document.forgive(*channel, "has neither <color> nor <float>, <param> or <texture>",
                             kNoParameter);
    return {};
}

/// A number of the model, or `otherwise`.
double readFactor(const Context& context, const Scope& scope, const Element& model,
                  const char* name, double otherwise) {
    const Channel channel = readChannel(context, scope, model, name);
    return channel.numbers ? readNumber(context.document, *channel.numbers) : otherwise;
}

/// One opacity for all channels, which is all that a surface has here.
double luminanceOf(const glm::dvec3& color) {
    return glm::dot(color, glm::dvec3(0.212671, 0.715160, 0.072169)); // those of the standard
}

/// Opacity as <transparent> and <transparency> define it together.
struct Opacity {
    Channel channel;   ///< of <transparent>
    std::string mode;  ///< its `opaque`
    double factor = 1; ///< <transparency>
    double value = 1;  ///< where there is no picture
    bool isInAlpha() const { return mode == "A_ONE" || mode == "A_ZERO"; }
    bool isTransparency() const { return mode == "A_ZERO" || mode == "RGB_ZERO"; }
};

Opacity readOpacity(const Context& context, const Scope& scope, const Element& model) {
    Opacity opacity;
    opacity.factor = readFactor(context, scope, model, "transparency", 1);
    opacity.channel = readChannel(context, scope, model, "transparent");
    const Element* element = model.FirstChildElement("transparent");
    const char* attribute = element ? element->Attribute("opaque") : nullptr;
    opacity.mode = attribute ? attribute : "A_ONE";
    const bool isKnown =
        opacity.isInAlpha() || opacity.mode == "RGB_ZERO" || opacity.mode == "RGB_ONE";
    if (!isKnown) {
        context.document.forgive(*element, fmt::format("opaque=\"{}\"", opacity.mode),
                                 "A_ONE is taken");
        opacity.mode = "A_ONE";
    }
    glm::dvec4 color(1);
    if (opacity.channel.numbers) {
        const std::vector<double> numbers = readNumbers(context.document, *opacity.channel.numbers);
        for (size_t i = 0; i < numbers.size() && i < 4; ++i)
            color[int(i)] = numbers[i];
    }
    const double stated =
        (opacity.isInAlpha() ? color.a : luminanceOf(glm::dvec3(color))) * opacity.factor;
    // Without <transparent> only what <transparency> says counts, as opacity.
    opacity.value = opacity.isTransparency() ? 1 - stated : stated;
    const double inside = std::clamp(opacity.value, 0.0, 1.0);
    if (std::abs(inside - opacity.value) > 1e-6)
        context.report.warn("<transparency>: an opacity outside [0, 1] is clamped to it");
    // A luminance of white differs from 1 by rounding.
    opacity.value = inside > 1 - 1e-6 ? 1 : inside < 1e-6 ? 0 : inside;
    return opacity;
}

/// Reports the parts of the model that are not rendered.
void reportIgnored(Context& context, const Scope& scope, const Element& model) {
    const auto report = [&](const char* name, bool hasEffect, const char* why) {
        if (hasEffect) context.report.ignore(fmt::format("<{}>", name), why);
    };
    const auto isLit = [&](const char* name) {
        const Channel channel = readChannel(context, scope, model, name);
        if (channel.kind != ChannelKind::Numbers) return channel.kind == ChannelKind::Texture;
        return readColor(context.document, *channel.numbers) != glm::vec3(0);
    };
    report("ambient", isLit("ambient"), "light is computed, not added");
}

/// Reads the textures of one effect.
class TexturedChannels {
  public:
    TexturedChannels(Context& context, Textures& textures, const Scope& scope,
                     EffectMaterial& result)
        : context_(context), textures_(textures), scope_(scope), result_(result) {}

    /// Adds the texture of a channel; false if there is none, of which `reading` says what comes of
    /// it.
    bool add(const Channel& channel, const char* name, TextureSlot slot, const char* reading,
             float scale = 1) {
        if (!context_.conventions.textures) {
            context_.report.ignore(fmt::format("<texture> of <{}>", name), reading);
            return false;
        }
        const std::optional<uint32_t> number = textures_.read(scope_, *channel.texture, reading);
        if (!number) return false;
        const char* texcoord = channel.texture->Attribute("texcoord");
        result_.textures.push_back({slot, *number, texcoord ? texcoord : "", scale});
        return true;
    }

  private:
    Context& context_;
    Textures& textures_;
    const Scope& scope_;
    EffectMaterial& result_;
};

glm::vec3 readAlbedo(Context& context, const Channel& channel, TexturedChannels& textures) {
    if (channel.kind == ChannelKind::Numbers) return readFraction(context, *channel.numbers);
    if (channel.kind == ChannelKind::Absent) return glm::vec3(context.conventions.unstatedAlbedo);
    const bool found = textures.add(channel, "diffuse", TextureSlot::BaseColor, kGreyInstead);
    return found ? glm::vec3(1) : kMidGrey;
}

glm::vec3 readEmission(Context& context, const Channel& channel, TexturedChannels& textures) {
    if (channel.kind == ChannelKind::Absent) return glm::vec3(0);
    if (channel.kind == ChannelKind::Texture) {
        const bool found =
            textures.add(channel, "emission", TextureSlot::Emission, "the surface does not emit");
        return glm::vec3(found ? 1.0f : 0.0f);
    }
    const glm::vec3 emission = readLightColor(context, *channel.numbers);
    if (context.conventions.shadingModelsEmit || emission == glm::vec3(0)) return emission;
    context.report.ignore("<emission> of a shading model",
                          context.conventions.renderer + " does not read it");
    return glm::vec3(0);
}

/// A picture's texture coordinates go by the same name as those of the colours' one, mostly.
void useOpacity(Context& context, const Scope& scope, const Element& model, Material& material,
                const Channel& diffuse, TexturedChannels& textures) {
    if (!context.conventions.areDefault()) {
        if (model.FirstChildElement("transparent"))
            context.report.ignore("<transparent>", "surfaces are rendered opaque");
        return;
    }
    const Opacity opacity = readOpacity(context, scope, model);
    if (opacity.channel.kind != ChannelKind::Texture) {
        if (opacity.value == 1) return;
        material.alphaMode = AlphaMode::Blend;
        material.opacity = float(opacity.value);
        if (opacity.value == 0)
            context.report.warn(
                "a material is not seen: its opacity (<transparent>, <transparency>) is 0");
        return;
    }
    const bool isSamePicture = diffuse.kind == ChannelKind::Texture && diffuse.texture &&
                               opacity.channel.texture && diffuse.texture->Attribute("texture") &&
                               opacity.channel.texture->Attribute("texture") &&
                               std::string_view(diffuse.texture->Attribute("texture")) ==
                                   opacity.channel.texture->Attribute("texture");
    if (opacity.mode == "A_ONE" && isSamePicture) {
        // The alpha of a picture of the base colour is the opacity.
        material.alphaMode = AlphaMode::Blend;
        material.opacity = float(std::clamp(opacity.factor, 0.0, 1.0));
        return;
    }
    if (opacity.isInAlpha()) {
        context.report.ignore("<transparent> with the alpha of another picture than <diffuse>",
                              "the surface is opaque");
        return;
    }
    if (textures.add(opacity.channel, "transparent", TextureSlot::Opacity, "the surface is opaque",
                     opacity.isTransparency() ? -1.0f : 1.0f))
        material.alphaMode = AlphaMode::Blend;
}

/// Highlights as a rough dielectric coat that reflects <specular> at right angles, as of OBJ files
/// (docs/guide/obj_ply.md); <reflective> as a smooth one.
void useReflection(Context& context, const Scope& scope, const Element& model, Material& material) {
    const auto lit = [&](const char* name) {
        const Channel channel = readChannel(context, scope, model, name);
        if (channel.kind == ChannelKind::Texture) {
            context.report.ignore(fmt::format("<texture> of <{}>", name),
                                  "the surface has no such reflection");
            return glm::vec3(0);
        }
        return channel.numbers ? readFraction(context, *channel.numbers) : glm::vec3(0);
    };
    const glm::vec3 specular = lit("specular");
    // Exporters write a <reflective> of white for all they have, and mean <reflectivity>.
    const glm::vec3 reflective = lit("reflective");
    const double reflectivity = readFactor(context, scope, model, "reflectivity", 0);
    if (reflective != glm::vec3(0) && !model.FirstChildElement("reflectivity"))
        context.report.ignore("<reflective>", "there is no <reflectivity> to it");
    const glm::vec3 mirror = reflective * float(std::clamp(reflectivity, 0.0, 1.0));
    const double shininess = readFactor(context, scope, model, "shininess", 0);
    const bool isMirror = mirror != glm::vec3(0);
    const bool hasHighlight = specular != glm::vec3(0) && shininess > 0;
    if (!context.conventions.areDefault() || (!isMirror && !hasHighlight)) {
        if (specular != glm::vec3(0))
            context.report.ignore("<specular>", "there is no <shininess> above 0 to it");
        if (isMirror)
            context.report.ignore("<reflective>",
                                  context.conventions.renderer + " does not read it");
        return;
    }
    if (isMirror && hasHighlight)
        context.report.ignore("<specular>", "the surface has a <reflective> coat in its place");
    constexpr float reflectance = 0.04f; // of an index of 1.5 at right angles
    // Phong's angle is that to the mirrored ray: about twice that to the normal, so that the
    // exponent is a quarter of Blinn's. Exporters write some for blinn too; a fraction there is the
    // standard's own roughness.
    const bool isPhong = named(model, "phong");
    const double exponent = isPhong ? 4 * shininess : shininess;
    PrincipledParameters& p = material.principled;
    p.baseColor = material.albedo;
    p.metallic = 0;
    p.roughness = isMirror                     ? 0.0f
                  : !isPhong && shininess <= 1 ? float(std::sqrt(std::clamp(shininess, 0.0, 1.0)))
                                               : float(std::pow(2 / (exponent + 2), 0.25));
    p.specularColor = (isMirror ? mirror : specular) / reflectance;
    material.kind = MaterialKind::Principled;
}

const Element* shadingModel(const Element& technique) {
    for (const char* name : {"constant", "lambert", "phong", "blinn"})
        if (const Element* model = technique.FirstChildElement(name)) return model;
    return nullptr;
}

EffectMaterial readCommonProfile(Context& context, Textures& textures, const Element& effect,
                                 const Element& profile) {
    const Element* technique = profile.FirstChildElement("technique");
    const Element* model = technique ? shadingModel(*technique) : nullptr;
    EffectMaterial result;
    Material& material = result.material;
    material.albedo = kMidGrey;
    if (!model) {
        context.document.forgive(technique ? *technique : profile,
                                 "has none of <constant>, <lambert>, <phong>, <blinn>",
                                 kGreyInstead);
        return result;
    }
    if (context.conventions.shadingModels == ShadingModels::PhongOnly && !named(*model, "phong")) {
        context.report.ignore(fmt::format("<{}>", model->Name()),
                              context.conventions.renderer +
                                  " reads <phong> only; mid grey (0.5) takes its place");
        return result;
    }
    const Scope scope{technique, &profile, &effect};
    const bool constant = named(*model, "constant");
    TexturedChannels channels(context, textures, scope, result);
    const Channel diffuse = constant ? Channel{} : readChannel(context, scope, *model, "diffuse");
    material.albedo = constant ? glm::vec3(0) : readAlbedo(context, diffuse, channels);
    material.emission =
        readEmission(context, readChannel(context, scope, *model, "emission"), channels);
    useOpacity(context, scope, *model, material, diffuse, channels);
    if (!constant) useReflection(context, scope, *model, material);
    reportIgnored(context, scope, *model);
    return result;
}

} // namespace

glm::vec3 readFraction(Context& context, const Element& at) {
    return context.builder.reflectedFraction(fmt::format("<{}>", at.Name()),
                                             readColor(context.document, at));
}

glm::vec3 readLightColor(Context& context, const Element& at) {
    return context.builder.lightColor(fmt::format("<{}>", at.Name()),
                                      readColor(context.document, at));
}

EffectMaterial readEffect(Context& context, Textures& textures, const Element& effect,
                          const std::string& name) {
    EffectMaterial result;
    result.material.albedo = kMidGrey;
    if (std::optional<Material> dialect = readCglMaterial(context, effect))
        result.material = std::move(*dialect);
    else if (const Element* profile = effect.FirstChildElement("profile_COMMON"))
        result = readCommonProfile(context, textures, effect, *profile);
    else
        context.report.warn(fmt::format("effect '{}' has no <profile_COMMON>: {}",
                                        displayName(effect), kGreyInstead));
    result.material.name = name;
    return result;
}

} // namespace stromboli::collada

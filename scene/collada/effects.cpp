#include "scene/collada/effects.hpp"

#include "scene/collada/cgl_dialect.hpp"
#include "scene/collada/numbers.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
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

/// Opacity per channel as <transparent> and <transparency> define it together: true if all are 1.
bool isOpaque(const Context& context, const Scope& scope, const Element& model) {
    const double factor = readFactor(context, scope, model, "transparency", 1);
    const Channel channel = readChannel(context, scope, model, "transparent");
    if (channel.kind == ChannelKind::Texture) return false;
    glm::dvec4 color(1);
    if (channel.numbers) {
        const std::vector<double> numbers = readNumbers(context.document, *channel.numbers);
        for (size_t i = 0; i < numbers.size() && i < 4; ++i)
            color[int(i)] = numbers[i];
    }
    const Element* element = model.FirstChildElement("transparent");
    const char* attribute = element ? element->Attribute("opaque") : nullptr;
    const std::string mode = attribute ? attribute : "A_ONE";
    if (mode == "A_ZERO") return color.a * factor == 0;
    if (mode == "RGB_ZERO") return glm::dvec3(color) * factor == glm::dvec3(0);
    if (mode == "RGB_ONE") return glm::dvec3(color) * factor == glm::dvec3(1);
    return color.a * factor == 1;
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
    report("specular", isLit("specular"), "only diffuse reflection and emission are rendered");
    report("reflective",
           isLit("reflective") && readFactor(context, scope, model, "reflectivity", 1) != 0,
           "only diffuse reflection and emission are rendered");
    report("ambient", isLit("ambient"), "light is computed, not added");
    report("transparent", !isOpaque(context, scope, model), "surfaces are rendered opaque");
}

/// Reads the textures of one effect.
class TexturedChannels {
  public:
    TexturedChannels(Context& context, Textures& textures, const Scope& scope,
                     EffectMaterial& result)
        : context_(context), textures_(textures), scope_(scope), result_(result) {}

    /// Adds the texture of a channel; false if there is none, of which `reading` says what comes of
    /// it.
    bool add(const Channel& channel, const char* name, TextureSlot slot, const char* reading) {
        if (!context_.conventions.textures) {
            context_.report.ignore(fmt::format("<texture> of <{}>", name), reading);
            return false;
        }
        const std::optional<uint32_t> number = textures_.read(scope_, *channel.texture, reading);
        if (!number) return false;
        const char* texcoord = channel.texture->Attribute("texcoord");
        result_.textures.push_back({slot, *number, texcoord ? texcoord : ""});
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
    if (constant)
        material.albedo = glm::vec3(0);
    else
        material.albedo =
            readAlbedo(context, readChannel(context, scope, *model, "diffuse"), channels);
    material.emission =
        readEmission(context, readChannel(context, scope, *model, "emission"), channels);
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

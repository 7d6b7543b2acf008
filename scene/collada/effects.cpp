#include "scene/collada/effects.hpp"

#include "scene/collada/cgl_dialect.hpp"
#include "scene/collada/numbers.hpp"

#include <fmt/format.h>

#include <cstring>
#include <optional>
#include <string>

namespace stromboli::collada {
namespace {

const glm::vec3 kMidGrey(0.5f);
constexpr const char* kNoParameter = "the parameter counts as absent";

/// Where a shading model's parameter can be defined, innermost first.
struct Scope {
    const Element *technique, *profile, *effect;
};

const Element* findParameter(const Scope& scope, const char* sid) {
    for (const Element* place : {scope.technique, scope.profile, scope.effect})
        for (const Element& parameter : children(*place)) {
            const char* own = parameter.Attribute("sid");
            if (named(parameter, "newparam") && own && std::strcmp(own, sid) == 0)
                return &parameter;
        }
    return nullptr;
}

enum class ChannelKind { Absent, Numbers, Texture };

/// One parameter of a shading model, such as <diffuse>.
struct Channel {
    ChannelKind kind = ChannelKind::Absent;
    const Element* numbers = nullptr;
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
            return {ChannelKind::Numbers, value};
    return {ChannelKind::Texture, nullptr};
}

Channel readChannel(const Context& context, const Scope& scope, const Element& model,
                    const char* name) {
    const Element* channel = model.FirstChildElement(name);
    if (!channel) return {};
    if (const Element* param = channel->FirstChildElement("param"))
        return resolveParameter(context, scope, *param);
    if (channel->FirstChildElement("texture")) return {ChannelKind::Texture, nullptr};
    for (const char* type : {"color", "float"})
        if (const Element* numbers = channel->FirstChildElement(type))
            return {ChannelKind::Numbers, numbers};
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

glm::vec3 readAlbedo(Context& context, const Scope& scope, const Element& model) {
    const Channel channel = readChannel(context, scope, model, "diffuse");
    if (channel.kind == ChannelKind::Numbers) return readFraction(context, *channel.numbers);
    if (channel.kind == ChannelKind::Absent) return glm::vec3(context.conventions.unstatedAlbedo);
    context.report.ignore("<texture> of <diffuse>", kGreyInstead);
    return kMidGrey;
}

glm::vec3 readEmission(Context& context, const Scope& scope, const Element& model) {
    const Channel channel = readChannel(context, scope, model, "emission");
    if (channel.kind == ChannelKind::Absent) return glm::vec3(0);
    if (channel.kind == ChannelKind::Texture) {
        context.report.ignore("<texture> of <emission>", "the surface does not emit");
        return glm::vec3(0);
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

Material readCommonProfile(Context& context, const Element& effect, const Element& profile) {
    const Element* technique = profile.FirstChildElement("technique");
    const Element* model = technique ? shadingModel(*technique) : nullptr;
    Material material;
    material.albedo = kMidGrey;
    if (!model) {
        context.document.forgive(technique ? *technique : profile,
                                 "has none of <constant>, <lambert>, <phong>, <blinn>",
                                 kGreyInstead);
        return material;
    }
    if (context.conventions.shadingModels == ShadingModels::PhongOnly && !named(*model, "phong")) {
        context.report.ignore(fmt::format("<{}>", model->Name()),
                              context.conventions.renderer +
                                  " reads <phong> only; mid grey (0.5) takes its place");
        return material;
    }
    const Scope scope{technique, &profile, &effect};
    const bool constant = named(*model, "constant");
    material.albedo = constant ? glm::vec3(0) : readAlbedo(context, scope, *model);
    material.emission = readEmission(context, scope, *model);
    reportIgnored(context, scope, *model);
    return material;
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

Material readEffect(Context& context, const Element& effect, const std::string& name) {
    std::optional<Material> material = readCglMaterial(context, effect);
    if (!material) {
        const Element* profile = effect.FirstChildElement("profile_COMMON");
        if (profile) {
            material = readCommonProfile(context, effect, *profile);
        } else {
            context.report.warn(fmt::format("effect '{}' has no <profile_COMMON>: {}",
                                            displayName(effect), kGreyInstead));
            material.emplace().albedo = kMidGrey;
        }
    }
    material->name = name;
    return *material;
}

} // namespace stromboli::collada

#include "scene/collada/cgl_dialect.hpp"

#include "scene/collada/effects.hpp"
#include "scene/collada/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace stromboli::collada {
namespace {

/// Reads the children of one dialect element and remembers which, so that the rest is reported.
class Fields {
  public:
    Fields(Context& context, const Element& element) : context_(context), element_(element) {}

    glm::vec3 fraction(const char* name) { return readFraction(context_, field(name)); }
    glm::vec3 light(const char* name) { return readLightColor(context_, field(name)); }
    float positive(const char* name) {
        const Element& at = field(name);
        const float value = toFloat(context_.document, at, readNumber(context_.document, at));
        if (!(value > 0)) context_.document.fail(at, "must be greater than 0");
        return value;
    }

    void reportOthers() const {
        for (const Element& child : children(element_))
            if (std::find(read_.begin(), read_.end(), child.Name()) == read_.end())
                context_.report.ignore(fmt::format("<{}> of <{}>", child.Name(), element_.Name()),
                                       "the dialect gives it no meaning");
    }

  private:
    const Element& field(const char* name) {
        read_.push_back(name);
        return context_.document.require(element_, name);
    }

    Context& context_;
    const Element& element_;
    std::vector<std::string_view> read_;
};

std::optional<Material> readMaterial(Context& context, const Element& element) {
    const std::string_view kind = element.Name();
    Fields fields(context, element);
    Material material;
    if (kind == "emission") {
        material.albedo = glm::vec3(0);
        material.emission = fields.light("radiance");
    } else if (kind == "diffuse") {
        material.albedo = fields.fraction("reflectance");
    } else if (kind == "mirror") {
        material.kind = MaterialKind::Mirror;
        material.reflectance = fields.fraction("reflectance");
    } else if (kind == "refraction") {
        material.kind = MaterialKind::Refraction;
        material.transmittance = fields.fraction("transmittance");
        material.ior = fields.positive("ior");
    } else if (kind == "glass") {
        material.kind = MaterialKind::Dielectric;
        material.reflectance = fields.fraction("reflectance");
        material.transmittance = fields.fraction("transmittance");
        material.ior = fields.positive("ior");
    } else if (kind == "microfacet") {
        material.kind = MaterialKind::Conductor;
        const auto alpha = float(fields.positive("alpha"));
        material.facets = {FacetDistribution::Beckmann, glm::vec2(alpha)};
        material.eta = fields.light("eta");
        material.k = fields.light("k");
    } else {
        return std::nullopt;
    }
    fields.reportOthers();
    return material;
}

} // namespace

std::optional<Material> readCglMaterial(Context& context, const Element& effect) {
    const Element* technique = cglTechnique(effect);
    if (!technique) return std::nullopt;
    std::optional<Material> last;
    for (const Element& child : children(*technique)) {
        if (std::optional<Material> material = readMaterial(context, child)) {
            last = std::move(material);
        } else {
            context.report.ignore(fmt::format("<{}> of the dialect", child.Name()),
                                  "not a supported material");
        }
    }
    return last;
}

std::optional<double> readCglSphere(Context& context, const Element& geometry) {
    const Element* technique = cglTechnique(geometry);
    const Element* sphere = technique ? technique->FirstChildElement("sphere") : nullptr;
    if (!sphere) return std::nullopt;
    return readNumber(context.document, context.document.require(*sphere, "radius"));
}

const Element* findCglLight(Context& context, const Element& light) {
    const Element* technique = cglTechnique(light);
    const Element* kind = technique ? technique->FirstChildElement() : nullptr;
    if (!kind) return nullptr;
    for (const char* known : {"area", "ambient", "hemisphere", "directional", "point", "spot"})
        if (named(*kind, known)) return kind;
    context.report.ignore(fmt::format("<{}> of the dialect", kind->Name()),
                          "not a supported light; the light's common profile is used");
    return nullptr;
}

} // namespace stromboli::collada

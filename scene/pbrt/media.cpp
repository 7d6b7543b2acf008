#include "scene/pbrt/media.hpp"

#include "scene/pbrt/cloud.hpp"
#include "scene/pbrt/colors.hpp"
#include "scene/pbrt/medium_grids.hpp"

#include <fmt/format.h>

namespace stromboli::pbrt {
namespace {

/// What shines, by one colour: in proportion to the absorption.
void readEmission(const Context& context, const Parameters& p, Medium& medium) {
    const std::optional<glm::dvec3> color = colorOf(context, p, "Le", ColorOf::Light);
    const double scale = p.number("Lescale", 1, 0, 1e30);
    if (color) medium.emission = glm::dvec3(medium.absorption) * *color * scale;
}

} // namespace

build::Scattering wholeMilk() {
    return build::measuredMedium("wholemilk").value();
}

build::Scattering measured(const Parameters& p, std::string_view parameter,
                           const std::string& name) {
    const std::optional<build::Scattering> found = build::measuredMedium(name);
    if (!found)
        p.replaceParameter(parameter, build::Shortfall::Model,
                           "is '" + name + "', which is not known");
    return found.value_or(wholeMilk());
}

void Media::define(const std::string& name, const Parameters& p,
                   const glm::dmat4& worldFromMedium) {
    const std::string kind = p.text("type").value_or("homogeneous");
    const glm::dvec3 one(1.0);
    Medium medium;
    medium.name = name;
    const double scale = p.number("scale", 1, 0, 1e30);
    medium.asymmetry = float(p.number("g", 0, -double(kMostAsymmetry), double(kMostAsymmetry)));
    build::Scattering usual = wholeMilk();
    const std::optional<std::string> preset = p.text("preset");
    if (preset) usual = measured(p, "preset", *preset);
    if (kind == "rgbgrid") {
        readColoredGrid(p, scale, worldFromMedium, medium);
    } else if (kind == "nanovdb") {
        const auto color = [&](const char* what) {
            return scale * colorOf(context_, p, what, ColorOf::Number).value_or(glm::dvec3(1.0));
        };
        medium.absorption = color("sigma_a");
        medium.scattering = color("sigma_s");
        readNanoMedium(context_, p, worldFromMedium, medium);
    } else if (kind == "cloud") {
        medium.absorption = colorOf(context_, p, "sigma_a", ColorOf::Number).value_or(one);
        medium.scattering = colorOf(context_, p, "sigma_s", ColorOf::Number).value_or(one);
        medium.density = cloudOf(p, worldFromMedium);
    } else if (kind == "homogeneous" || kind == "uniformgrid" || kind == "heterogeneous") {
        const bool isGrid = kind != "homogeneous";
        const auto color = [&](const char* what, const glm::dvec3& otherwise) {
            return scale * colorOf(context_, p, what, ColorOf::Number)
                               .value_or(context_.isV3() || preset ? otherwise : one);
        };
        medium.absorption = color("sigma_a", usual.absorbed);
        medium.scattering = color("sigma_s", usual.scattered);
        if (isGrid) medium.density = gridOf(p, "density", worldFromMedium);
        if (isGrid && !context_.isV3())
            readGridEmission(context_, p, medium);
        else
            readEmission(context_, p, medium);
    } else {
        p.place().fail(fmt::format("is '{}', expected homogeneous, uniformgrid, rgbgrid, cloud, "
                                   "nanovdb or heterogeneous",
                                   kind));
    }
    p.skip({"type"});
    p.reportUnread();
    made_[name] = context_.builder.addMedium(std::move(medium));
}

uint32_t Media::named(const Statement& statement, const std::string& name) const {
    if (name.empty()) return kNoMedium;
    const auto found = made_.find(name);
    if (found != made_.end()) return found->second;
    context_.report().replace(statement.place, build::Shortfall::Reference,
                              fmt::format("names the medium '{}', which is not there", name));
    return kNoMedium;
}

MediumSides Media::between(const Statement& statement) const {
    MediumSides sides;
    sides.isStated = true;
    sides.inside = named(statement, statement.words.front());
    // One name stands for both sides.
    sides.outside =
        statement.words.size() < 2 ? sides.inside : named(statement, statement.words[1]);
    return sides;
}

} // namespace stromboli::pbrt

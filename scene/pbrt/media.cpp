#include "scene/pbrt/media.hpp"

#include "scene/pbrt/colors.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::pbrt {
namespace {

/// What pbrt takes for a medium that states nothing, per millimetre: whole milk, after Jensen,
/// Marschner, Levoy and Hanrahan, "A Practical Model for Subsurface Light Transport", 2001.
constexpr glm::dvec3 kUsualAbsorption{0.0011, 0.0024, 0.014}, kUsualScattering{2.55, 3.21, 3.77};

constexpr uint64_t kMostValues = uint64_t(1) << 31;

/// Densities that a parameter lists, nx times ny times nz of them, in the box from p0 to p1.
DensityGrid gridOf(const Parameters& p, const char* name, const glm::dmat4& worldFromMedium) {
    DensityGrid grid;
    uint64_t count = 1;
    constexpr const char* kSizes[] = {"nx", "ny", "nz"};
    for (int axis = 0; axis < 3; ++axis) {
        const int64_t size = p.integer(kSizes[axis]).value_or(1);
        if (size < 1 || size > 1 << 16)
            p.place().fail(
                fmt::format("has '{}' {}, expected from 1 to 65536", kSizes[axis], size));
        grid.size[axis] = uint32_t(size);
        count *= uint64_t(size);
    }
    const std::vector<double> values = p.numbers(name);
    if (count > kMostValues || values.size() != count)
        p.place().fail(
            fmt::format("has {} values of '{}', expected {}", values.size(), name, count));
    for (const double value : values)
        grid.values.push_back(std::isfinite(value) && value > 0 ? float(std::min(value, 1e30)) : 0);
    const glm::dvec3 low = p.vector("p0").value_or(glm::dvec3(0));
    const glm::dvec3 high = p.vector("p1").value_or(glm::dvec3(1));
    const glm::dvec3 size = high - low;
    if (size.x == 0 || size.y == 0 || size.z == 0) p.place().fail("has a box without a volume");
    const glm::dmat4 identity(1.0);
    grid.setWorld(worldFromMedium * glm::translate(identity, low) * glm::scale(identity, size));
    return grid;
}

/// The mean of colours that a parameter lists; negative channels count as 0.
glm::dvec3 meanOfTriples(const std::vector<double>& numbers) {
    glm::dvec3 sum(0.0);
    for (size_t i = 0; i + 2 < numbers.size(); i += 3)
        sum += glm::max(glm::dvec3(numbers[i], numbers[i + 1], numbers[i + 2]), 0.0);
    return numbers.size() < 3 ? sum : sum / double(numbers.size() / 3);
}

/// A grid that lists absorption and scattering by colour (rgbgrid): the colours become their means,
/// and the densities follow the mean extinction of each cell.
void readColoredGrid(const Context& context, const Parameters& p, double scale, Medium& medium,
                     const glm::dmat4& worldFromMedium) {
    const Parameter* a = p.find("sigma_a");
    const Parameter* s = p.find("sigma_s");
    const std::vector<double> absorption = a ? a->numbers : std::vector<double>();
    const std::vector<double> scattering = s ? s->numbers : std::vector<double>();
    const size_t count = std::max(absorption.size(), scattering.size()) / 3;
    Statement densities;
    densities.place = p.place();
    densities.parameters = p.all();
    Parameter density;
    density.type = "float";
    density.name = "density";
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        double extinction = 0;
        for (const auto* list : {&absorption, &scattering})
            for (size_t c = 0; c < 3 && 3 * i + c < list->size(); ++c)
                extinction += std::max((*list)[3 * i + c], 0.0) / 3;
        density.numbers.push_back(extinction);
        sum += extinction;
    }
    densities.parameters.push_back(density);
    medium.density = gridOf(Parameters(densities, context.report()), "density", worldFromMedium);
    const double mean = count > 0 ? sum / double(count) : 0;
    if (mean > 0) {
        medium.absorption = scale * meanOfTriples(absorption) / mean;
        medium.scattering = scale * meanOfTriples(scattering) / mean;
    }
    for (const char* size : {"nx", "ny", "nz", "p0", "p1"})
        (void)p.find(size);
    p.replace(build::Shortfall::Model, "has colours that vary from place to place",
              "their means, with densities that vary");
}

/// What shines: emission in proportion to the absorption in pbrt-v4.
void readEmission(const Context& context, const Parameters& p, Medium& medium) {
    const std::optional<glm::dvec3> color = colorOf(context, p, "Le", ColorOf::Light);
    const double scale = p.number("Lescale", 1, 0, 1e30);
    if (color) medium.emission = glm::dvec3(medium.absorption) * *color * scale;
    for (const char* unread :
         {"temperature", "temperaturescale", "temperatureoffset", "temperaturecutoff"})
        if (p.has(unread))
            p.replaceParameter(unread, build::Shortfall::Parameter, "makes it glow by its heat");
}

} // namespace

void Media::define(const std::string& name, const Parameters& p,
                   const glm::dmat4& worldFromMedium) {
    const std::string kind = p.text("type").value_or("homogeneous");
    Medium medium;
    medium.name = name;
    const double scale = p.number("scale", 1, 0, 1e30);
    medium.asymmetry = float(p.number("g", 0, -double(kMostAsymmetry), double(kMostAsymmetry)));
    if (const std::optional<std::string> preset = p.text("preset"))
        p.replaceParameter("preset", build::Shortfall::Model, "is '" + *preset + "'");
    if (kind == "rgbgrid") {
        readColoredGrid(context_, p, scale, medium, worldFromMedium);
    } else if (kind == "homogeneous" || kind == "uniformgrid" || kind == "heterogeneous") {
        const bool isGrid = kind != "homogeneous";
        const glm::dvec3 one(1.0);
        const auto color = [&](const char* what, const glm::dvec3& usual) {
            return scale * colorOf(context_, p, what, ColorOf::Number)
                               .value_or(isGrid && !context_.isV3() ? one : usual);
        };
        medium.absorption = color("sigma_a", kUsualAbsorption);
        medium.scattering = color("sigma_s", kUsualScattering);
        if (isGrid) medium.density = gridOf(p, "density", worldFromMedium);
    } else {
        p.place().fail(fmt::format("is '{}', expected homogeneous, uniformgrid, rgbgrid or "
                                   "heterogeneous",
                                   kind));
    }
    readEmission(context_, p, medium);
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

#include "scene/mitsuba/media.hpp"

#include "scene/build/tolerate.hpp"
#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/media_tables.hpp"
#include "scene/mitsuba/scattering_tables.hpp"
#include "scene/mitsuba/volumes.hpp"
#include "scene/mitsuba/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

/// What Mitsuba 3 takes for a medium that states nothing.
constexpr double kUsualAlbedo = 0.75, kUsualExtinction = 1;

/// The shares of a sum's parts, as many as there are.
std::vector<double> sharesOf(const Context& context, const Plugin& phase, size_t parts) {
    std::vector<double> shares;
    if (phase.type == "blendphase") {
        const Plugin* volume = phase.child("weight");
        double second = 0;
        if (volume && volume->tag == "volume") {
            const Volume read = readVolume(context, *volume);
            if (read.grid)
                volume->replace(build::Shortfall::Model, "varies from place to place", "its mean");
            second = std::clamp(read.mean.x, 0.0, 1.0);
        } else {
            second = phase.number("weight", 0, 1).value_or(0.5);
        }
        shares = {1 - second, second};
    } else {
        shares = numbersOf(phase.place, phase.requireText("weights"));
    }
    if (shares.size() != parts)
        phase.replaceParameter(
            phase.type == "blendphase" ? "weight" : "weights", build::Shortfall::Number,
            fmt::format("has {} numbers for {} phase functions", shares.size(), parts));
    shares.resize(parts, 0);
    return shares;
}

/// Adds what a phase function is a sum of, `share` of it in all.
void addPhase(const Context& context, const Plugin& phase, double share,
              std::vector<PhaseLobe>& lobes) {
    PhaseLobe lobe{PhaseFunction::HenyeyGreenstein, 0, float(share)};
    if (phase.type == "blendphase" || phase.type == "mixturephase") {
        const std::vector<const Plugin*> parts = phase.childrenOf("phase");
        const std::vector<double> shares = sharesOf(context, phase, parts.size());
        for (size_t i = 0; i < parts.size(); ++i)
            addPhase(context, *parts[i], share * std::max(shares[i], 0.0), lobes);
        return phase.requireAllRead();
    }
    if (phase.type == "rayleigh") {
        lobe.phase = PhaseFunction::Rayleigh;
    } else if (phase.type == "hg") {
        lobe.asymmetry = float(phase.number("g").value_or(0.8));
    } else if (phase.type != "isotropic") {
        phase.replace(build::Shortfall::Model,
                      fmt::format("'{}' is no phase function that is read, expected isotropic, hg, "
                                  "rayleigh, blendphase or mixturephase",
                                  phase.type),
                      "isotropic");
        return lobes.push_back(lobe);
    }
    phase.requireAllRead();
    lobes.push_back(lobe);
}

void readPhase(const Context& context, const Plugin& phase, Medium& medium) {
    std::vector<PhaseLobe> lobes;
    addPhase(context, phase, 1, lobes);
    if (!medium.setPhases(std::move(lobes)))
        phase.replace(build::Shortfall::Model,
                      fmt::format("is a sum of more than {} phase functions", kMostPhases),
                      "those with the largest shares");
}

/// The share of light that is scattered.
Volume albedoOf(const Context& context, const Plugin& plugin) {
    const Plugin* volume = plugin.child("albedo");
    if (volume && volume->tag == "volume") return readVolume(context, *volume);
    Volume constant;
    constant.mean = colorOf(plugin, "albedo", ColorOf::Index).value_or(glm::dvec3(kUsualAlbedo));
    return constant;
}

/// Where the extinction is the same everywhere.
glm::dvec3 meanAlbedo(const Context& context, const Plugin& plugin) {
    const Volume albedo = albedoOf(context, plugin);
    if (albedo.grid)
        plugin.child("albedo")->replace(build::Shortfall::Model,
                                        "varies from place to place and the extinction does not",
                                        "its mean");
    return albedo.mean;
}

/// A volume that varies, as colours in the world.
ColorGrid colorsOf(const Context& context, const Volume& volume) {
    ColorGrid colors;
    if (volume.colors) colors = *volume.colors;
    colors.size = volume.grid->size;
    if (!volume.colors)
        for (const float value : volume.grid->values)
            colors.values.emplace_back(value);
    colors.setWorld(context.worldFromFile * volume.toFile);
    return colors;
}

void setColors(Medium& medium, const glm::dvec3& extinction, const glm::dvec3& albedo) {
    const glm::dvec3 share = glm::clamp(albedo, 0.0, 1.0);
    medium.scattering = extinction * share;
    medium.absorption = extinction * (1.0 - share);
}

/// Mitsuba 3 calls the density sigma_t, 0.x density.
void readHeterogeneous(const Context& context, const Plugin& plugin, double scale, Medium& medium) {
    const char* name = plugin.isOld ? "density" : "sigma_t";
    const Plugin* volume = plugin.child(name);
    if (!volume) plugin.fail(fmt::format("has no volume '{}'", name));
    Volume density = readVolume(context, *volume);
    if (!density.grid) return setColors(medium, scale * density.mean, meanAlbedo(context, plugin));
    const Volume albedo = albedoOf(context, plugin);
    setColors(medium, glm::dvec3(scale), albedo.mean);
    if (albedo.grid) {
        medium.colors.scattering = colorsOf(context, albedo);
        for (glm::vec3& share : medium.colors.scattering->values)
            share = glm::min(share, 1.0f);
    }
    if (density.colors) {
        medium.colors.extinction = colorsOf(context, density);
    } else {
        density.grid->setWorld(context.worldFromFile * density.toFile);
        medium.density = std::move(density.grid);
    }
}

void readHomogeneous(const Context& context, const Plugin& plugin, double scale, Medium& medium) {
    const bool isOfTable = plugin.has("material");
    const bool isByParts = plugin.has("sigma_s") || plugin.has("sigma_a");
    if (isOfTable || isByParts || (plugin.isOld && !plugin.has("sigma_t"))) {
        const Scattering s = scatteringOf(plugin);
        medium.scattering = scale * s.scattered;
        medium.absorption = scale * s.absorbed;
        return;
    }
    const Plugin* volume = plugin.child("sigma_t");
    const bool isVolume = volume && volume->tag == "volume";
    const glm::dvec3 extinction =
        isVolume
            ? readVolume(context, *volume).mean
            : colorOf(plugin, "sigma_t", ColorOf::Index).value_or(glm::dvec3(kUsualExtinction));
    setColors(medium, scale * extinction, meanAlbedo(context, plugin));
}

} // namespace

Sides sidesOf(const Plugin& shape) {
    Sides sides;
    for (const Plugin::Child& child : shape.children()) {
        if (child.plugin->tag != "medium") continue;
        (child.name == "exterior" ? sides.outside : sides.inside) = child.plugin;
    }
    (void)shape.childrenOf("medium");
    sides.under = shape.onlyChildOf("subsurface");
    return sides;
}

uint32_t Media::of(const Plugin* medium) {
    if (!medium) return kNoMedium;
    const auto [found, isNew] = made_.try_emplace(medium, kNoMedium);
    if (isNew)
        build::tolerate(context_.report(), build::Shortfall::Medium, [&] {
            const uint32_t number = context_.builder.addMedium(make(*medium));
            made_[medium] = number;
        });
    return made_[medium];
}

uint32_t Media::under(const Plugin& subsurface, Material& surface) {
    const auto [found, isNew] = made_.try_emplace(&subsurface, kNoMedium);
    if (isNew)
        build::tolerate(context_.report(), build::Shortfall::Medium, [&] {
            const uint32_t number = context_.builder.addMedium(makeUnder(subsurface));
            made_[&subsurface] = number;
        });
    if (made_[&subsurface] == kNoMedium) return kNoMedium;
    Material interface;
    interface.name = surface.name;
    interface.kind = MaterialKind::Dielectric;
    interface.ior = float(refractiveIndex(subsurface, "int_ior", "bk7") /
                          refractiveIndex(subsurface, "ext_ior", "air"));
    const bool hasFacets =
        surface.kind == MaterialKind::Plastic || surface.kind == MaterialKind::Dielectric;
    if (hasFacets) interface.facets = surface.facets, interface.reflectance = surface.reflectance;
    surface = interface;
    return made_[&subsurface];
}

Medium Media::makeUnder(const Plugin& plugin) {
    if (plugin.type != "dipole" && plugin.type != "adipole" && plugin.type != "mdipole" &&
        plugin.type != "singlescatter")
        plugin.fail(fmt::format("'{}' is no subsurface that is read, expected dipole, adipole, "
                                "mdipole or singlescatter",
                                plugin.type));
    Medium medium;
    medium.name = plugin.displayName();
    medium.isUnderSurface = true;
    const double scale = plugin.number("scale", 0).value_or(1);
    const Scattering s = scatteringOf(plugin);
    medium.scattering = scale * s.scattered;
    medium.absorption = scale * s.absorbed;
    medium.asymmetry =
        float(plugin.number("g", -double(kMostAsymmetry), double(kMostAsymmetry)).value_or(0));
    // How samples are taken, and not what of.
    for (const char* unused :
         {"irr_samples", "quality", "irr_indirect", "int_ior", "ext_ior", "fast_single_scatter",
          "fast_single_scatter_samples", "single_scatter_shadow_rays", "single_scatter_depth",
          "single_scatter_t_depth", "distance_correction", "multi_scatter_layers", "thickness"})
        plugin.skip(unused);
    plugin.requireAllRead();
    return medium;
}

Medium Media::make(const Plugin& plugin) {
    Medium medium;
    medium.name = plugin.displayName();
    const double scale = plugin.number("scale", 0).value_or(1);
    if (const Plugin* phase = plugin.onlyChildOf("phase")) readPhase(context_, *phase, medium);
    if (plugin.type == "heterogeneous")
        readHeterogeneous(context_, plugin, scale, medium);
    else if (plugin.type == "homogeneous")
        readHomogeneous(context_, plugin, scale, medium);
    else
        plugin.fail(fmt::format("'{}' is no medium that is read, expected homogeneous or "
                                "heterogeneous",
                                plugin.type));
    // How samples are taken, and not what of.
    for (const char* unused :
         {"sample_emitters", "has_spectral_extinction", "strategy", "method", "majorant_grid_res",
          "majorant_resolution_factor", "step_size", "monochromatic", "sampling_density"})
        plugin.skip(unused);
    (void)plugin.childrenOf("volume");
    plugin.requireAllRead();
    return medium;
}

} // namespace stromboli::mitsuba

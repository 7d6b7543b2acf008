#include "scene/mitsuba/integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace stromboli::mitsuba {
namespace {

/// Where the file sets no limit; paths end by Russian roulette long before.
constexpr int64_t kMostBounces = 10000;

/// Ways to the same picture as that of the path tracer.
constexpr std::array<std::string_view, 14> kOtherWays = {
    "bdpt", "pssmlt",  "mlt", "erpt",      "photonmapper",   "ppm",        "sppm",
    "vpl",  "ptracer", "prb", "prb_basic", "prb_projective", "prbvolpath", "guidedpath"};

/// What has an integrator inside that does the work.
constexpr std::array<std::string_view, 6> kWrappers = {"moment",   "aov",          "irrcache",
                                                       "adaptive", "multichannel", "stokes"};

/// A depth of 1 is what the camera sees shine, of 2 direct light.
uint32_t bouncesOf(const Plugin& integrator) {
    const int64_t depth = integrator.integer("max_depth").value_or(-1);
    if (depth < -1)
        integrator.replaceParameter("max_depth", build::Shortfall::Number,
                                    fmt::format("is {}, expected -1 or more", depth));
    if (depth <= -1) return kMostBounces;
    return uint32_t(std::clamp<int64_t>(depth - 1, 0, kMostBounces));
}

/// Mitsuba's depth after the first scattering is 1, and roulette sets in from this depth on.
std::optional<int64_t> rouletteStartOf(const Plugin& integrator) {
    const std::optional<int64_t> depth = integrator.integer("rr_depth");
    if (!depth) return std::nullopt;
    if (*depth < 1)
        integrator.replaceParameter("rr_depth", build::Shortfall::Number,
                                    fmt::format("is {}, expected 1 or more", *depth));
    return std::clamp<int64_t>(*depth, 1, kMostBounces);
}

void readWrapper(Context& context, const Plugin& integrator) {
    const Plugin* inside = integrator.onlyChildOf("integrator");
    if (integrator.type == "aov")
        context.report().ignore("integrator 'aov'", "--layers writes layers");
    else if (integrator.type != "moment")
        context.report().assume(
            fmt::format("integrator '{}': the one inside it renders the picture", integrator.type));
    integrator.skip("aovs");
    ignoreUnread(context, integrator);
    if (inside) readIntegrator(context, *inside);
}

void readPath(Context& context, const Plugin& integrator) {
    const std::string& type = integrator.type;
    context.builder.hints().maxBounces = bouncesOf(integrator);
    if (type == "path" || type == "volpath" || type == "volpathmis") return;
    if (std::ranges::find(kOtherWays, type) != kOtherWays.end())
        context.report().assume(
            fmt::format("integrator '{}': path takes its place, of the same depth", type));
    else
        integrator.replace(build::Shortfall::Model,
                           fmt::format("'{}' is no integrator that is read", type),
                           "path, of the same depth");
}

} // namespace

void readIntegrator(Context& context, const Plugin& integrator) {
    const std::string& type = integrator.type;
    if (std::ranges::find(kWrappers, type) != kWrappers.end())
        return readWrapper(context, integrator);
    RenderHints& hints = context.builder.hints();
    if (const std::optional<int64_t> start = rouletteStartOf(integrator))
        hints.rouletteStart = uint32_t(*start);
    if (type == "direct" || type == "direct_projective") {
        hints.maxBounces = 1;
        for (const char* unused : {"shading_samples", "emitter_samples", "bsdf_samples"})
            integrator.skip(unused);
    } else if (type == "depth") {
        hints.showsDepth = true;
        context.report().assume("integrator 'depth': distances are from the camera, of the first "
                                "surface; Mitsuba's begin at near_clip");
    } else {
        readPath(context, integrator);
    }
    hints.hidesBackdrop = integrator.flag("hide_emitters").value_or(false);
    ignoreUnread(context, integrator);
}

} // namespace stromboli::mitsuba

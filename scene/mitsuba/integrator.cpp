#include "scene/mitsuba/integrator.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::mitsuba {
namespace {

/// Where the file sets no limit; paths end by Russian roulette long before.
constexpr int64_t kMostBounces = 10000;

/// A depth of 1 is what the camera sees shine, of 2 direct light.
uint32_t bouncesOf(const Plugin& integrator) {
    const int64_t depth = integrator.integer("max_depth").value_or(-1);
    if (depth < -1) integrator.fail("max_depth", fmt::format("is {}, expected -1 or more", depth));
    if (depth == -1) return kMostBounces;
    return uint32_t(std::clamp<int64_t>(depth - 1, 0, kMostBounces));
}

/// Mitsuba's depth after the first scattering is 1, and roulette sets in from this depth on.
std::optional<int64_t> rouletteStartOf(const Plugin& integrator) {
    const std::optional<int64_t> depth = integrator.integer("rr_depth");
    if (depth && *depth < 1)
        integrator.fail("rr_depth", fmt::format("is {}, expected 1 or more", *depth));
    if (depth) return std::min<int64_t>(*depth, kMostBounces);
    return std::nullopt;
}

} // namespace

void readIntegrator(Context& context, const Plugin& integrator) {
    const std::string& type = integrator.type;
    if (type == "moment" || type == "aov") {
        const Plugin* inside = integrator.onlyChildOf("integrator");
        if (type == "aov") context.report().ignore("integrator 'aov'", "--layers writes layers");
        integrator.skip("aovs");
        ignoreUnread(context, integrator);
        if (inside) readIntegrator(context, *inside);
        return;
    }
    RenderHints& hints = context.builder.hints();
    if (const std::optional<int64_t> start = rouletteStartOf(integrator))
        hints.rouletteStart = uint32_t(*start);
    if (type == "path" || type == "volpath" || type == "volpathmis") {
        hints.maxBounces = bouncesOf(integrator);
    } else if (type == "direct") {
        hints.maxBounces = 1;
        for (const char* unused : {"shading_samples", "emitter_samples", "bsdf_samples"})
            integrator.skip(unused);
    } else if (type == "depth") {
        hints.showsDepth = true;
        context.report().assume("integrator 'depth': distances are from the camera, of the first "
                                "surface; Mitsuba's begin at near_clip");
    } else {
        integrator.fail(fmt::format("'{}' is no integrator that is read, expected path, volpath, "
                                    "direct, depth, moment or aov",
                                    type));
    }
    hints.hidesBackdrop = integrator.flag("hide_emitters").value_or(false);
    ignoreUnread(context, integrator);
}

} // namespace stromboli::mitsuba

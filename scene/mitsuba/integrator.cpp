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
    if (type == "path" || type == "volpath" || type == "volpathmis") {
        hints.maxBounces = bouncesOf(integrator);
    } else if (type == "direct") {
        hints.maxBounces = 1;
        for (const char* unused : {"shading_samples", "emitter_samples", "bsdf_samples"})
            integrator.skip(unused);
    } else if (type == "depth") {
        context.report().warn("integrator 'depth': light is followed; --layers writes depths");
    } else {
        integrator.fail(fmt::format("'{}' is no integrator that is read, expected path, volpath, "
                                    "direct, depth, moment or aov",
                                    type));
    }
    if (integrator.flag("hide_emitters").value_or(false)) {
        hints.hidesBackdrop = true;
        context.report().assume(
            "hide_emitters hides the environment; surfaces that shine are seen");
    }
    ignoreUnread(context, integrator);
}

} // namespace stromboli::mitsuba

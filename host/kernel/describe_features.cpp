#include "host/kernel/kernel_features.hpp"
#include "shaders/shared/texture_types.h"

#include <fmt/format.h>

#include <utility>

namespace stromboli {
namespace {

bool hasTerminatorOffset(const KernelFeatures& f) {
    return f[SPEC_CORNER_NORMALS] && !f[SPEC_CS184] && !f[SPEC_FLAT_TERMINATOR];
}

std::string list(uint32_t bits, const std::vector<const char*>& names) {
    std::string text;
    for (uint32_t i = 0; i < names.size(); ++i)
        if (bits & (1u << i)) text += (text.empty() ? "" : ", ") + std::string(names[i]);
    return text.empty() ? "none" : text;
}

const char* ambientText(const KernelFeatures& f) {
    if (!f[SPEC_HAS_AMBIENT]) return "none";
    if (f[SPEC_HAS_ENVIRONMENT]) return "an environment, sampled by its radiance";
    return f[SPEC_LIGHT_KINDS] & 1u << gpu::LIGHT_AMBIENT ? "sampled" : "left to bounces";
}

std::string textureText(const KernelFeatures& f) {
    if (!f[SPEC_TEXTURE_SLOTS]) return "none";
    return list(f[SPEC_TEXTURE_SLOTS],
                {"base color", "metallic-roughness", "normal", "emission", "transmission",
                 "specular", "specular color", "clearcoat", "clearcoat roughness",
                 "clearcoat normal", "sheen color", "sheen roughness", "anisotropy", "height",
                 "share of a mixture", "of a projector", "opacity"});
}

/// Closures, lobes and recipes that occur.
std::string closureText(const KernelFeatures& f) {
    using namespace gpu;
    const uint32_t some = f[SPEC_CLOSURES], all = f[SPEC_CLOSURES_OF_ALL];
    const bool hasFacets = (some & CLOSURE_INTERFACE) && !(all & INTERFACE_IS_SMOOTH);
    const std::pair<bool, const char*> parts[] = {
        {some & CLOSURE_BASE, "diffuse"},
        {some & INTERFACE_IS_SMOOTH, "smooth interfaces"},
        {hasFacets && !(all & FACETS_ARE_BECKMANN), "GGX microfacets"},
        {some & FACETS_ARE_BECKMANN, "Beckmann microfacets"},
        {some & FACETS_ARE_TURNED, "grain"},
        {some & INTERFACE_IS_CONDUCTOR, "conductors"},
        {some & INTERFACE_IS_DIELECTRIC, "dielectrics"},
        {some & INTERFACE_REFRACTS, "refraction"},
        {some & INTERFACE_IS_THIN, "thin sheets"},
        {some & CLOSURE_LAYERS, "bases under interfaces"},
        {some & CLOSURE_COAT, "clear coat"},
        {some & CLOSURE_SHEEN, "sheen"},
        {some & VOLUME_ABSORBS, "absorption"},
        {some & RECIPE_PRINCIPLED, "glTF's recipe"},
        {some & RECIPE_BURLEY, "Burley's recipe"}};
    std::string text;
    for (const auto& [occurs, name] : parts)
        if (occurs) text += (text.empty() ? "" : ", ") + std::string(name);
    return text.empty() ? "none" : text;
}

} // namespace

std::vector<std::string> describe(const KernelFeatures& f) {
    static const char* const kDirect[] = {"light sampling", "uniform hemisphere",
                                          "left to bounces (delta lights sampled)"};
    static const char* const kFilters[] = {"box", "Gaussian", "Blackman-Harris", "tent",
                                           "negative in places, samples have weights"};
    static const char* const kIntegrators[] = {"path", "normals", "depth"};
    static const char* const kRoulette[] = {"none", "by throughput", "fixed probability"};
    const std::string primitives =
        list(f[SPEC_HAS_TRIANGLES] | (f[SPEC_HAS_SPHERES] << 1), {"triangles", "spheres"});
    return {
        fmt::format("primitives: {}", primitives),
        fmt::format("instances: {}",
                    f[SPEC_HAS_PLACEMENTS] ? "meshes that share their triangles" : "none"),
        fmt::format("shading normals: {}", f[SPEC_CORNER_NORMALS] ? "interpolated"
                                           : f[SPEC_HAS_NORMALS]  ? "of maps"
                                                                  : "none"),
        fmt::format("materials: {}", closureText(f)),
        fmt::format("textures: {}", textureText(f)),
        fmt::format("vertex colors: {}",
                    f[SPEC_ATTRIBUTES] & gpu::ATTRIBUTE_COLOR ? "yes" : "none"),
        fmt::format("opacity: {}", f[SPEC_HAS_ALPHA] ? "partly transparent" : "all opaque"),
        fmt::format("emission: {}", f[SPEC_HAS_EMISSION] ? "yes" : "none"),
        fmt::format("lights: {}", list(f[SPEC_LIGHT_KINDS],
                                       {"quad", "triangle", "sphere", "ambient", "directional",
                                        "point", "spot", "environment", "projector"})),
        fmt::format("ambient light: {}{}", ambientText(f),
                    f[SPEC_HAS_BACKDROP] ? ", seen by the camera" : ""),
        fmt::format("integrator: {}", kIntegrators[f[SPEC_INTEGRATOR]]),
        fmt::format("direct light: {}{}", kDirect[f[SPEC_DIRECT_LIGHT]],
                    f[SPEC_MIS_LOBES] ? ", shared with bounces (MIS)" : ""),
        fmt::format(
            "sampler: {}",
            nameOf(f[SPEC_SAMPLER] == gpu::SAMPLER_SOBOL ? Sampler::Sobol : Sampler::Independent)),
        fmt::format("roulette: {}", kRoulette[f[SPEC_ROULETTE]]),
        fmt::format("paths: {}", f[SPEC_SPLITS] ? "with branches" : "each by itself"),
        fmt::format("bounces: {}", f[SPEC_GAP_PROPOSAL] ? "some into the gap behind the light"
                                                        : "by the materials"),
        fmt::format("camera: {}{}", f[SPEC_ORTHOGRAPHIC] ? "orthographic" : "perspective",
                    f[SPEC_HAS_LENS] ? ", through a lens" : ""),
        fmt::format("pixel filter: {}", kFilters[f[SPEC_PIXEL_FILTER]]),
        fmt::format("CS184 conventions: {}", f[SPEC_CS184] ? "yes" : "no"),
        fmt::format("terminator offset: {}", hasTerminatorOffset(f) ? "yes" : "none"),
        fmt::format("traversal stack: {} entries{}", f[SPEC_STACK_SIZE],
                    f[SPEC_LARGE_TREE] ? " of two words" : ""),
    };
}

} // namespace stromboli

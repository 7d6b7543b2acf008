#include "host/kernel/kernel_features.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace stromboli {
namespace {

static_assert(Roulette::kThroughputStart == gpu::ROULETTE_THROUGHPUT_START);
static_assert(float(Roulette::kMaxContinue) == gpu::ROULETTE_MAX_CONTINUE);
static_assert(float(Roulette::kBoldness) == gpu::ROULETTE_BOLDNESS);

uint32_t materialKinds(const GpuScene& scene) {
    uint32_t kinds = 0;
    for (const gpu::Primitive& p : scene.primitives)
        kinds |= 1u << scene.materials[materialOf(p)].kind;
    return kinds;
}

bool hasEmission(const GpuScene& scene) {
    return std::any_of(scene.primitives.begin(), scene.primitives.end(),
                       [&](const gpu::Primitive& p) {
                           const glm::vec3& e = scene.materials[materialOf(p)].emission;
                           return e.x > 0 || e.y > 0 || e.z > 0;
                       });
}

/// Lights that are sampled; an ambient light is also found by rays that miss.
uint32_t lightKinds(const GpuScene& scene, const Estimator& settings) {
    if (settings.integrator == Integrator::Normals) return 0;
    uint32_t kinds = 0;
    for (const gpu::Light& light : scene.lights) {
        const bool isArea = light.kind < gpu::LIGHT_DIRECTIONAL;
        const bool sampled =
            samplesLights(settings.directLight) ||
            (!isArea && !(settings.cs184 && settings.directLight == DirectLight::Hemisphere)) ||
            (light.kind == gpu::LIGHT_AMBIENT && !settings.cs184);
        if (sampled) kinds |= 1u << light.kind;
    }
    return kinds;
}

uint32_t lightNumbers(const GpuScene& scene, const Estimator& settings) {
    // The samples of a mesh take all four numbers of a block; those of delta lights none.
    uint32_t area = 0;
    for (const gpu::Light& light : scene.lights) {
        if (light.kind == gpu::LIGHT_MESH) return gpu::LIGHT_NUMBERS_OWN;
        area += light.kind < gpu::LIGHT_DIRECTIONAL;
    }
    return area * settings.lightSamples <= 1 && !settings.cs184 ? gpu::LIGHT_NUMBERS_SHARED
                                                                : gpu::LIGHT_NUMBERS_FIRST;
}

bool misIsWanted(const Estimator& settings) {
    return settings.directLight == DirectLight::Mis && !settings.cs184;
}

/// Where bounces from rough metals may find what light samples find too.
bool usesMis(const GpuScene& scene, const Estimator& settings, uint32_t materialKinds) {
    const bool metal = materialKinds & 1u << gpu::MATERIAL_MICROFACET;
    return metal && misIsWanted(settings) &&
           std::any_of(scene.lights.begin(), scene.lights.end(), [](const gpu::Light& light) {
               return light.kind == gpu::LIGHT_SPHERE || light.kind == gpu::LIGHT_AMBIENT ||
                      light.flags & gpu::LIGHT_FOUND_BY_BOUNCES;
           });
}

bool guidesBounces(const GpuScene& scene, const Estimator& settings) {
    return settings.guides && scene.lampGap != 0 && samplesLights(settings.directLight) &&
           settings.integrator == Integrator::Path && !settings.cs184 && settings.maxBounces > 1;
}

void switchOnAllTheSceneCouldHave(KernelFeatures& f, const Estimator& settings) {
    f[SPEC_HAS_TRIANGLES] = f[SPEC_HAS_SPHERES] = f[SPEC_HAS_NORMALS] = f[SPEC_HAS_EMISSION] = 1;
    f[SPEC_ONE_LIGHT] = 0;
    if (f[SPEC_LIGHT_NUMBERS] == gpu::LIGHT_NUMBERS_SHARED)
        f[SPEC_LIGHT_NUMBERS] = gpu::LIGHT_NUMBERS_FIRST;
    f[SPEC_MATERIAL_KINDS] = (2u << gpu::MATERIAL_MICROFACET) - 1;
    f[SPEC_LIGHT_KINDS] = (2u << gpu::LIGHT_SPOT) - 1;
    f[SPEC_USE_MIS] = misIsWanted(settings);
}

std::string list(uint32_t bits, const std::vector<const char*>& names) {
    std::string text;
    for (uint32_t i = 0; i < names.size(); ++i)
        if (bits & (1u << i)) text += (text.empty() ? "" : ", ") + std::string(names[i]);
    return text.empty() ? "none" : text;
}

} // namespace

KernelFeatures kernelFeatures(const GpuScene& scene, const Camera& camera,
                              const Estimator& settings, const DeviceTuning& tuning) {
    const bool normalsOnly = settings.integrator == Integrator::Normals;
    KernelFeatures f{};
    f[SPEC_WORKGROUP_SIZE] = tuning.workgroupSize;
    f[SPEC_TRAVERSAL_STEPS] = tuning.traversalSteps;
    f[SPEC_STACK_SIZE] = std::max(scene.bvh.stackSize, 1u);
    f[SPEC_STACK_IN_REGISTERS] = f[SPEC_STACK_SIZE] <= tuning.registerStack;
    f[SPEC_HAS_TRIANGLES] = scene.hasTriangles;
    f[SPEC_HAS_SPHERES] = scene.hasSpheres;
    f[SPEC_HAS_NORMALS] = scene.hasNormals;
    f[SPEC_MATERIAL_KINDS] = normalsOnly ? 0 : materialKinds(scene);
    f[SPEC_HAS_EMISSION] = !normalsOnly && hasEmission(scene);
    f[SPEC_LIGHT_KINDS] = lightKinds(scene, settings);
    f[SPEC_INTEGRATOR] = normalsOnly ? gpu::INTEGRATOR_NORMALS : gpu::INTEGRATOR_PATH;
    f[SPEC_DIRECT_LIGHT] = samplesLights(settings.directLight) ? gpu::DIRECT_LIGHTS
                           : settings.directLight == DirectLight::Hemisphere
                               ? gpu::DIRECT_HEMISPHERE
                               : gpu::DIRECT_BSDF;
    f[SPEC_ROULETTE] = settings.roulette.mode == Roulette::Mode::None ? gpu::ROULETTE_NONE
                       : settings.roulette.mode == Roulette::Mode::Throughput
                           ? gpu::ROULETTE_THROUGHPUT
                           : gpu::ROULETTE_FIXED;
    // Roulette by throughput never acts on paths shorter than where it starts.
    if (settings.roulette.mode == Roulette::Mode::Throughput &&
        settings.maxBounces < gpu::ROULETTE_THROUGHPUT_START)
        f[SPEC_ROULETTE] = gpu::ROULETTE_NONE;
    f[SPEC_ORTHOGRAPHIC] = camera.orthographic;
    f[SPEC_CLIP_ALONG_RAY] = camera.clipAlongRay;
    f[SPEC_CS184] = settings.cs184;
    f[SPEC_ONE_LIGHT] = scene.lights.size() == 1;
    f[SPEC_LIGHT_SAMPLES] = settings.lightSamples;
    f[SPEC_LIGHT_CHOICE] = !scene.manyLampTriangles                  ? gpu::LIGHT_CHOICE_AREA
                           : scene.lightChoice == LightChoice::Tree  ? gpu::LIGHT_CHOICE_TREE
                           : scene.lightChoice == LightChoice::Power ? gpu::LIGHT_CHOICE_POWER
                                                                     : gpu::LIGHT_CHOICE_UNIFORM;
    f[SPEC_SAMPLER] =
        settings.sampler == Sampler::Sobol ? gpu::SAMPLER_SOBOL : gpu::SAMPLER_INDEPENDENT;
    f[SPEC_LIGHT_NUMBERS] = lightNumbers(scene, settings);
    f[SPEC_USE_MIS] = usesMis(scene, settings, f[SPEC_MATERIAL_KINDS]);
    f[SPEC_SPLITS] = settings.branches > 1;
    f[SPEC_GUIDES] = guidesBounces(scene, settings);
    f[SPEC_COUNT_STEPS] = tuning.countSteps;
    if (tuning.everythingOn) switchOnAllTheSceneCouldHave(f, settings);
    return f;
}

std::vector<std::string> describe(const KernelFeatures& f) {
    static const char* const kDirect[] = {"light sampling", "uniform hemisphere",
                                          "left to bounces (delta lights sampled)"};
    static const char* const kRoulette[] = {"none", "by throughput", "fixed probability"};
    const std::string primitives =
        list(f[SPEC_HAS_TRIANGLES] | (f[SPEC_HAS_SPHERES] << 1), {"triangles", "spheres"});
    return {
        fmt::format("primitives: {}", primitives),
        fmt::format("shading normals: {}", f[SPEC_HAS_NORMALS] ? "interpolated" : "none"),
        fmt::format("materials: {}",
                    list(f[SPEC_MATERIAL_KINDS],
                         {"diffuse", "mirror", "refraction", "glass", "microfacet"})),
        fmt::format("emission: {}", f[SPEC_HAS_EMISSION] ? "yes" : "none"),
        fmt::format("lights: {}", list(f[SPEC_LIGHT_KINDS], {"quad", "mesh", "sphere", "ambient",
                                                             "directional", "point", "spot"})),
        fmt::format("integrator: {}",
                    nameOf(f[SPEC_INTEGRATOR] == gpu::INTEGRATOR_PATH ? Integrator::Path
                                                                      : Integrator::Normals)),
        fmt::format("direct light: {}{}", kDirect[f[SPEC_DIRECT_LIGHT]],
                    f[SPEC_USE_MIS] ? ", with bounces from rough metals" : ""),
        fmt::format(
            "sampler: {}",
            nameOf(f[SPEC_SAMPLER] == gpu::SAMPLER_SOBOL ? Sampler::Sobol : Sampler::Independent)),
        fmt::format("roulette: {}", kRoulette[f[SPEC_ROULETTE]]),
        fmt::format("paths: {}", f[SPEC_SPLITS] ? "with branches" : "each by itself"),
        fmt::format("bounces: {}",
                    f[SPEC_GUIDES] ? "some into the gap behind the lamp" : "by the materials"),
        fmt::format("camera: {}", f[SPEC_ORTHOGRAPHIC] ? "orthographic" : "perspective"),
        fmt::format("CS184 conventions: {}", f[SPEC_CS184] ? "yes" : "no"),
        fmt::format("traversal stack: {} entries", f[SPEC_STACK_SIZE]),
    };
}

} // namespace stromboli

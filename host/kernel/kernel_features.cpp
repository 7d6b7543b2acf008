#include "host/kernel/kernel_features.hpp"

#include "host/kernel/direct_sampling.hpp"
#include "shaders/shared/texture_types.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include <fmt/format.h>

namespace stromboli {
namespace {

/// Whether a service pass has more to do than the plainest scenes ask for: textures, layered
/// materials, environments, filters. Such kernels trace longer between two services (DeviceTuning).
bool servesForLong(const KernelFeatures& f) {
    constexpr uint32_t kPlain = gpu::CLOSURE_BASE | gpu::CLOSURE_INTERFACE | gpu::INTERFACE_BITS |
                                gpu::INTERFACE_REFRACTS | gpu::LOBE_MASK | gpu::HAS_BASE_COLOR;
    return (f[SPEC_CLOSURES] & ~(kPlain | gpu::FACETS_ARE_BECKMANN)) != 0 ||
           (f[SPEC_LIGHT_KINDS] & 1u << gpu::LIGHT_PROJECTOR) != 0 ||
           f[SPEC_HAS_ENVIRONMENT] != 0 || f[SPEC_HAS_BACKDROP] != 0 || f[SPEC_HAS_LENS] != 0 ||
           f[SPEC_PIXEL_FILTER] != gpu::FILTER_BOX || f[SPEC_FILTER_EXTRA] != 0 ||
           f[SPEC_HIDES_SURFACES] != 0 || f[SPEC_FLAT_TERMINATOR] != 0 ||
           f[SPEC_TEXTURE_SLOTS] != 0 || f[SPEC_LOOSE_SLOTS] != 0 || f[SPEC_LOOSE_TEXTURES] != 0 ||
           f[SPEC_TEXEL_KINDS] != 0 || f[SPEC_ATTRIBUTES] != 0 || f[SPEC_HAS_ALPHA] != 0 ||
           f[SPEC_TANGENT_FRAMES] != 0 || f[SPEC_HAS_BLENDS] != 0 || f[SPEC_RELIEF_RULES] != 0 ||
           f[SPEC_HAS_PLACEMENTS] != 0 || f[SPEC_CORNER_NORMALS] != f[SPEC_HAS_NORMALS];
}

static_assert(float(Roulette::kMaxContinue) == gpu::ROULETTE_MAX_CONTINUE);
static_assert(float(Roulette::kBoldness) == gpu::ROULETTE_BOLDNESS);

/// Kinds of lights that light samples go to.
uint32_t lightKinds(const GpuScene& scene, const Estimator& settings) {
    const bool samples = settings.integrator == Integrator::Path &&
                         directSampling(scene.lights, settings).lights > 0;
    return samples ? scene.lights.sampledKinds : 0;
}

uint32_t lightNumbers(const GpuScene& scene, const Estimator& settings) {
    const DirectSampling direct = directSampling(scene.lights, settings);
    return direct.hemisphere + direct.lights <= 1 ? gpu::LIGHT_NUMBERS_SHARED
                                                  : gpu::LIGHT_NUMBERS_FIRST;
}

bool combinesBouncesAndLightSamples(const Estimator& settings) {
    return combinesWithBounces(settings.directLight) && settings.conventions.bouncesFindAllLight;
}

/// Lobes from which MIS helps: where light samples and bounces find the same light, and either
/// often finds it better (docs/estimator.md, "MIS").
uint32_t misLobes(const GpuScene& scene, const Estimator& settings) {
    if (!combinesBouncesAndLightSamples(settings) || scene.lights.areaCount == 0) return 0;
    const bool skyAlone = scene.lights.sampledKinds == 1u << gpu::LIGHT_AMBIENT;
    const bool isPicture = scene.lights.environment != nullptr;
    const bool everywhere = skyAlone || isPicture || settings.directLight == DirectLight::MisAll;
    const uint32_t helped = everywhere ? ~gpu::DELTA_LOBES : gpu::GLOSSY_LOBES;
    return scene.closures.some & gpu::LOBE_MASK & helped;
}

bool proposesGap(const GpuScene& scene, const Estimator& settings) {
    return settings.gapProposal && scene.gapWidth != 0 && samplesLights(settings.directLight) &&
           settings.integrator == Integrator::Path && settings.maxBounces > 1;
}

/// The shaders have two sets of conventions, told apart by one constant (include/cs184.glsl).
/// The terminator offset is a constant by itself.
uint32_t conventionsConstant(ShadingConventions conventions) {
    if (conventions == cs184Shading()) return 1;
    conventions.offsetsTerminator = true;
    if (conventions == ShadingConventions{}) return 0;
    throw std::invalid_argument("the kernel has no mixture of two sets of shading conventions");
}

uint32_t integratorConstant(Integrator integrator) {
    switch (integrator) {
    case Integrator::Path:
        return gpu::INTEGRATOR_PATH;
    case Integrator::Normals:
        return gpu::INTEGRATOR_NORMALS;
    case Integrator::Depth:
        return gpu::INTEGRATOR_DEPTH;
    }
    return gpu::INTEGRATOR_PATH;
}

uint32_t filterConstant(PixelFilter filter) {
    switch (filter) {
    case PixelFilter::Box:
        return gpu::FILTER_BOX;
    case PixelFilter::Gaussian:
        return gpu::FILTER_GAUSSIAN;
    case PixelFilter::Tent:
        return gpu::FILTER_TENT;
    case PixelFilter::BlackmanHarris:
        return gpu::FILTER_BLACKMAN_HARRIS;
    case PixelFilter::Mitchell:
    case PixelFilter::CatmullRom:
    case PixelFilter::Lanczos:
        return gpu::FILTER_TABLE;
    }
    return gpu::FILTER_BOX;
}

void switchOnAllTheSceneCouldHave(KernelFeatures& f, const Estimator& settings) {
    f[SPEC_HAS_TRIANGLES] = f[SPEC_HAS_SPHERES] = f[SPEC_HAS_EMISSION] = 1;
    f[SPEC_HAS_NORMALS] = f[SPEC_CORNER_NORMALS] = 1;
    f[SPEC_LARGE_TREE] = f[SPEC_HAS_AMBIENT] = f[SPEC_HAS_ENVIRONMENT] = 1;
    if (f[SPEC_LIGHT_NUMBERS] == gpu::LIGHT_NUMBERS_SHARED)
        f[SPEC_LIGHT_NUMBERS] = gpu::LIGHT_NUMBERS_FIRST;
    f[SPEC_CLOSURES] = gpu::CLOSURE_MASK;
    f[SPEC_CLOSURES_OF_ALL] = 0;
    f[SPEC_LIGHT_KINDS] = (1u << gpu::LIGHT_KIND_COUNT) - 1;
    if (f[SPEC_LIGHT_GROUPS]) f[SPEC_LIGHT_GROUPS] = (1u << gpu::LIGHT_GROUP_COUNT) - 1;
    if (combinesBouncesAndLightSamples(settings)) f[SPEC_MIS_LOBES] |= gpu::GLOSSY_LOBES;
}

void setDetails(KernelFeatures& f, const GpuScene& scene, bool normalsOnly) {
    f[SPEC_HAS_ALPHA] = scene.hasAlpha;
    f[SPEC_HIDES_SURFACES] = scene.hasHidden;
    // Normals are those of the geometry: only what is not there has to be known.
    constexpr uint32_t kOpacityMaps = 1u << gpu::TEXTURE_BASE_COLOR | 1u << gpu::TEXTURE_OPACITY;
    const uint32_t wanted = !normalsOnly ? ~0u : scene.hasAlpha ? kOpacityMaps : 0;
    f[SPEC_TEXTURE_SLOTS] = scene.textureSlots & wanted;
    f[SPEC_LOOSE_SLOTS] = scene.looseSlots & wanted;
    f[SPEC_LOOSE_TEXTURES] = f[SPEC_LOOSE_SLOTS] ? scene.mostTextures : 0;
    f[SPEC_TEXEL_KINDS] = scene.texelKinds;
    f[SPEC_ATTRIBUTES] = scene.attributes;
    if (normalsOnly) return;
    f[SPEC_TANGENT_FRAMES] = scene.hasTangentFrames;
    f[SPEC_HAS_BLENDS] = scene.hasBlends;
    f[SPEC_RELIEF_RULES] = scene.hasReliefRules;
    // A map gives flat surfaces a shading normal too.
    constexpr uint32_t kMaps = 1u << gpu::TEXTURE_NORMAL | 1u << gpu::TEXTURE_HEIGHT;
    if (f[SPEC_TEXTURE_SLOTS] & kMaps) f[SPEC_HAS_NORMALS] = 1;
}

} // namespace

uint32_t lightChoiceConstant(const LightTable& lights) {
    if (lights.count == 1) return gpu::LIGHT_CHOICE_ONE;
    switch (lights.choice) {
    case LightChoice::Automatic: // has been resolved by packLights()
    case LightChoice::Tree:
        return gpu::LIGHT_CHOICE_TREE;
    case LightChoice::Power:
        return gpu::LIGHT_CHOICE_POWER;
    case LightChoice::Uniform:
        return gpu::LIGHT_CHOICE_UNIFORM;
    case LightChoice::Each:
        return gpu::LIGHT_CHOICE_EACH;
    }
    return gpu::LIGHT_CHOICE_TREE;
}

KernelFeatures kernelFeatures(const GpuScene& scene, const Camera& camera,
                              const Estimator& settings, const DeviceTuning& tuning) {
    const bool normalsOnly = settings.integrator != Integrator::Path; // or distances
    KernelFeatures f{};
    f[SPEC_WORKGROUP_SIZE] = tuning.workgroupSize;
    f[SPEC_TRAVERSAL_STEPS] = tuning.traversalSteps;
    f[SPEC_STACK_SIZE] = std::max(scene.bvh.stackSize, 1u);
    f[SPEC_STACK_IN_REGISTERS] = f[SPEC_STACK_SIZE] <= tuning.registerStack;
    f[SPEC_HAS_PLACEMENTS] = scene.hasPlacements;
    // Groups of two words have the bit that tells the world from prototypes (traverse.glsl).
    f[SPEC_LARGE_TREE] = scene.hasPlacements || scene.bvh.records.size() > gpu::SMALL_TREE_RECORDS;
    f[SPEC_HAS_TRIANGLES] = scene.hasTriangles;
    f[SPEC_HAS_SPHERES] = scene.hasSpheres;
    f[SPEC_HAS_NORMALS] = f[SPEC_CORNER_NORMALS] = scene.hasNormals;
    f[SPEC_CLOSURES] = normalsOnly ? 0 : scene.closures.some;
    f[SPEC_CLOSURES_OF_ALL] = normalsOnly ? 0 : scene.closures.all & scene.closures.some;
    f[SPEC_HAS_EMISSION] = !normalsOnly && scene.hasEmission;
    f[SPEC_BLACK_BACKS] = !normalsOnly && scene.hasBlackBacks;
    f[SPEC_LIGHT_KINDS] = lightKinds(scene, settings);
    f[SPEC_INTEGRATOR] = integratorConstant(settings.integrator);
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
        settings.maxBounces < settings.roulette.throughputStart)
        f[SPEC_ROULETTE] = gpu::ROULETTE_NONE;
    f[SPEC_ROULETTE_START] = settings.roulette.throughputStart;
    f[SPEC_ORTHOGRAPHIC] = camera.orthographic;
    f[SPEC_HAS_LENS] = camera.lensRadius > 0;
    f[SPEC_PIXEL_FILTER] = filterConstant(settings.filter);
    f[SPEC_FILTER_EXTRA] = std::bit_cast<uint32_t>(float(settings.filterShape.width - 1));
    f[SPEC_CLIP_ALONG_RAY] = camera.clipAlongRay;
    f[SPEC_CS184] = conventionsConstant(settings.conventions);
    f[SPEC_FLAT_TERMINATOR] = scene.hasNormals && settings.conventions.facesForward &&
                              !settings.conventions.offsetsTerminator;
    f[SPEC_LIGHT_SAMPLES] = directSampling(scene.lights, settings).perLight;
    f[SPEC_LIGHT_CHOICE] = lightChoiceConstant(scene.lights);
    f[SPEC_LIGHT_GROUPS] = scene.lights.groups;
    f[SPEC_SAMPLER] =
        settings.sampler == Sampler::Sobol ? gpu::SAMPLER_SOBOL : gpu::SAMPLER_INDEPENDENT;
    f[SPEC_LIGHT_NUMBERS] = lightNumbers(scene, settings);
    f[SPEC_MIS_LOBES] = normalsOnly ? 0 : misLobes(scene, settings);
    f[SPEC_HAS_AMBIENT] = !normalsOnly && scene.lights.hasAmbient;
    f[SPEC_HAS_ENVIRONMENT] = !normalsOnly && scene.lights.environment != nullptr;
    f[SPEC_HAS_BACKDROP] = !normalsOnly && scene.lights.hasBackdrop && settings.showsBackdrop;
    f[SPEC_AMBIENT_BY_BOUNCES] = !normalsOnly && scene.lights.ambientLeftToBounces;
    f[SPEC_SPLITS] = settings.branches > 1;
    f[SPEC_GAP_PROPOSAL] = proposesGap(scene, settings);
    f[SPEC_COUNT_STEPS] = tuning.countSteps;
    setDetails(f, scene, normalsOnly);
    if (tuning.everythingOn) switchOnAllTheSceneCouldHave(f, settings);
    f[SPEC_TRAVERSAL_LEGS] = 1;
    if (servesForLong(f)) f[SPEC_TRAVERSAL_STEPS] = tuning.richTraversalSteps;
    if (scene.hasPlacements) {
        f[SPEC_TRAVERSAL_STEPS] = tuning.placedTraversalSteps;
        f[SPEC_TRAVERSAL_LEGS] = tuning.traversalLegs;
    }
    return f;
}

} // namespace stromboli

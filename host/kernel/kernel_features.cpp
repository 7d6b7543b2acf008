#include "host/kernel/kernel_features.hpp"

#include "host/kernel/light_table.hpp"
#include "shaders/shared/medium_types.h"
#include "shaders/shared/render_types.h"
#include "shaders/shared/texture_types.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <type_traits>

namespace stromboli {

// --- Features ------------------------------------------------------------------------------------

namespace {

/// Whether a service pass has more to do than the plainest scenes ask for: textures, layered
/// materials, environments, filters. Such kernels trace longer between two services (DeviceTuning).
bool servesForLong(const KernelFeatures& f) {
    constexpr uint32_t kPlain = gpu::CLOSURE_BASE | gpu::CLOSURE_INTERFACE | gpu::INTERFACE_BITS |
                                gpu::INTERFACE_REFRACTS | gpu::FACETS_ARE_BECKMANN |
                                gpu::LOBE_MASK | gpu::HAS_BASE_COLOR;
    return (f[SPEC_LIGHT_KINDS] & 1u << gpu::LIGHT_PROJECTOR) != 0 ||
           f[SPEC_CORNER_NORMALS] != f[SPEC_HAS_NORMALS] ||
           f[SPEC_PIXEL_FILTER] != gpu::FILTER_BOX || (f[SPEC_CLOSURES] & ~kPlain) != 0 ||
           f[SPEC_HAS_IRIDESCENCE] != 0 || f[SPEC_HAS_ENVIRONMENT] != 0 || f[SPEC_MEDIA] != 0 ||
           f[SPEC_FLAT_TERMINATOR] != 0 || f[SPEC_HIDES_SURFACES] != 0 || f[SPEC_HAS_LENS] != 0 ||
           f[SPEC_HAS_DISPERSION] != 0 || f[SPEC_LOOSE_TEXTURES] != 0 || f[SPEC_HAS_ALPHA] != 0 ||
           f[SPEC_HAS_PLACEMENTS] != 0 || f[SPEC_TANGENT_FRAMES] != 0 ||
           f[SPEC_TEXTURE_SLOTS] != 0 || f[SPEC_HAS_BACKDROP] != 0 || f[SPEC_FILTER_EXTRA] != 0 ||
           f[SPEC_RELIEF_RULES] != 0 || f[SPEC_LOOSE_SLOTS] != 0 || f[SPEC_TEXEL_KINDS] != 0 ||
           f[SPEC_HAS_BLENDS] != 0 || f[SPEC_ATTRIBUTES] != 0;
}

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

/// Rules of light that go together. What bounces and light samples both find is shared by their
/// densities, of which the kernel has those of the default rules; rectangles have no power by which
/// they could be chosen; and of emissive geometry, samples are by solid angle.
void checkConventions(const ShadingConventions& c) {
    const bool isShared = c.samplesEmitters && c.ambientAboutNormal && !c.hemispherePerLight;
    if (c.bouncesFindAllLight && !isShared)
        throw std::invalid_argument("bounces find no light that is sampled by other conventions");
    if (!c.samplesEmitters && !c.everyLightInTurn)
        throw std::invalid_argument("rectangles are sampled where every light is, in turn");
    if (!c.inverseSquareFalloff && c.samplesEmitters)
        throw std::invalid_argument("emissive geometry falls off with the square of the distance");
}

/// Lobes from which MIS helps: where light samples and bounces find the same light, and either
/// often finds it better (docs/theory/estimator.md, "MIS").
uint32_t misLobes(const GpuScene& scene, const Estimator& settings) {
    const bool leaves = !scene.lights.leftToBounces.empty();
    if (!combinesBouncesAndLightSamples(settings)) return 0;
    if (scene.lights.areaCount == 0 && !leaves) return 0;
    const bool skyAlone = scene.lights.sampledKinds == 1u << gpu::LIGHT_AMBIENT;
    const bool isPicture = scene.lights.environment != nullptr;
    // Bounces from media find light as those from diffuse surfaces do, and narrow phases better.
    const bool scatters = (scene.media & gpu::MEDIA_SCATTER) != 0;
    const bool everywhere =
        skyAlone || scatters || isPicture || leaves || settings.directLight == DirectLight::MisAll;
    const uint32_t helped = everywhere ? ~gpu::DELTA_LOBES : gpu::GLOSSY_LOBES;
    return scene.closures.some & gpu::LOBE_MASK & helped;
}

bool proposesGap(const GpuScene& scene, const Estimator& settings) {
    return mayAimBounces(settings) && scene.gapWidth != 0 && scene.mostOthers == 0;
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

uint32_t directLightConstant(DirectLight mode) {
    if (samplesLights(mode)) return gpu::DIRECT_LIGHTS;
    return mode == DirectLight::Hemisphere ? gpu::DIRECT_HEMISPHERE : gpu::DIRECT_BSDF;
}

/// Roulette by throughput never acts on paths shorter than where it starts.
uint32_t rouletteConstant(const GpuScene& scene, const Estimator& settings) {
    switch (settings.roulette.mode) {
    case Roulette::Mode::None:
        return gpu::ROULETTE_NONE;
    case Roulette::Mode::Fixed:
        return gpu::ROULETTE_FIXED;
    case Roulette::Mode::Throughput:
        return settings.maxBounces < settings.roulette.throughputStart &&
                       (scene.media & gpu::MEDIA_UNDER_SURFACE) == 0
                   ? gpu::ROULETTE_NONE
                   : gpu::ROULETTE_THROUGHPUT;
    }
    return gpu::ROULETTE_NONE;
}

/// The textures that the kernel looks up, as bits of TEXTURE_ slots. Where surfaces do not scatter,
/// only what is not there has to be known.
uint32_t texturesWanted(const GpuScene& scene, bool shades) {
    constexpr uint32_t kOpacityMaps = 1u << gpu::TEXTURE_BASE_COLOR | 1u << gpu::TEXTURE_OPACITY;
    return shades ? ~0u : scene.hasAlpha ? kOpacityMaps : 0;
}

/// Maps give flat surfaces a shading normal too.
constexpr uint32_t kNormalMaps = 1u << gpu::TEXTURE_NORMAL | 1u << gpu::TEXTURE_HEIGHT;

/// With fewer steps than a ray takes, the service is run for the few lanes that are done; with
/// more, these wait. The longer the service, the more it pays to wait (docs/results.md, "Steps
/// between two services"). The numbers are even, so that scenes share kernels.
uint32_t traversalSteps(const KernelFeatures& f, const GpuScene& scene,
                        const DeviceTuning& tuning) {
    if (f[SPEC_HAS_PLACEMENTS]) return tuning.placedTraversalSteps;
    const bool isLong = servesForLong(f);
    if (!tuning.stepsFitRays || !scene.ofRay.isKnown())
        return isLong ? tuning.richTraversalSteps : tuning.traversalSteps;
    constexpr double kLeast = 4, kMost = 16;
    const double wanted = isLong ? 2 + 1.25 * scene.ofRay.records : scene.ofRay.records;
    return uint32_t(std::clamp(2 * std::round(wanted / 2), kLeast, kMost));
}

/// Whether rays meet so few spheres that to test one in every step takes longer than to have it
/// wait (docs/results.md, "Spheres that wait").
bool spheresWait(const GpuScene& scene) {
    constexpr double kFew = 0.5;
    return scene.hasSpheres && scene.hasTriangles && !scene.hasPlacements &&
           scene.ofRay.isKnown() && scene.ofRay.spheres <= kFew;
}

/// The 32 bits of a constant.
template <class Type>
uint32_t word(auto value) {
    if constexpr (std::is_same_v<Type, float>)
        return std::bit_cast<uint32_t>(float(value));
    else
        return uint32_t(Type(value));
}

} // namespace

uint32_t departures(const ShadingConventions& conventions) {
#define DEPARTURE(bit, member, name, otherwise) (conventions.member ? 0u : bit) |
    return CONVENTION_LIST(DEPARTURE) 0u;
#undef DEPARTURE
}

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
    using uint = uint32_t;
    checkConventions(settings.conventions);
    const bool shades = settings.integrator == Integrator::Path;
    KernelFeatures f{};
    f[SPEC_WORKGROUP_SIZE] = tuning.workgroupSize;
#define SET_FEATURE(number, type, name, standard, value, all, label, shown, adds)                  \
    f[number] = word<type>(value);                                                                 \
    if (tuning.everythingOn) {                                                                     \
        [[maybe_unused]] const uint32_t own = f[number];                                           \
        f[number] = uint32_t(all);                                                                 \
    }
    KERNEL_FEATURES(SET_FEATURE)
#undef SET_FEATURE
    return f;
}

bool mayAimBounces(const Estimator& settings) {
    return settings.gapProposal && samplesLights(settings.directLight) &&
           settings.integrator == Integrator::Path && settings.maxBounces > 1;
}

bool aimsBounces(const GpuScene& scene, const Estimator& settings) {
    return mayAimBounces(settings) && scene.lit && !scene.lit->cells.empty() &&
           !proposesGap(scene, settings);
}

bool mayLightThroughGlass(const GpuScene& scene, const Estimator& settings) {
    return samplesLights(settings.directLight) && settings.integrator == Integrator::Path &&
           settings.maxBounces > 1 && scene.media == 0 && scene.mostOthers == 0 &&
           !scene.hasDispersion && (scene.closures.some & gpu::LOBE_DELTA_TRANSMISSION) != 0;
}

bool lightsThroughGlass(const GpuScene& scene, const Estimator& settings) {
    constexpr double kLeastShare = 0.02;
    return mayLightThroughGlass(scene, settings) && scene.glassBeforeLights >= kLeastShare;
}

bool mayGuideLight(const GpuScene& scene, const Estimator& settings) {
    return settings.guidesLight &&
           (lightKinds(scene, settings) & 1u << gpu::LIGHT_ENVIRONMENT) != 0;
}

bool guidesLight(const GpuScene& scene, const Estimator& settings) {
    const bool aims = aimsAtPortals(scene, settings) && !scene.portals.all.empty();
    return mayGuideLight(scene, settings) && scene.guide && !aims;
}

bool aimsAtPortals(const GpuScene& scene, const Estimator& settings) {
    constexpr uint32_t kSkies = 1u << gpu::LIGHT_ENVIRONMENT | 1u << gpu::LIGHT_AMBIENT;
    return settings.aimsAtPortals && (lightKinds(scene, settings) & kSkies) != 0 &&
           settings.conventions.ambientAboutNormal;
}

bool mayLookAtOccluders(const GpuScene& scene, const Estimator& settings) {
    return lightKinds(scene, settings) != 0 && !lightsThroughGlass(scene, settings);
}

uint32_t occludersLookedAt(const GpuScene& scene, const Estimator& settings) {
    const bool looks = scene.looksAtOccluders == true && mayLookAtOccluders(scene, settings);
    return looks ? gpu::MOST_OCCLUDERS : 0;
}

bool mayLookAtShadowMap(const GpuScene& scene, const Estimator& settings) {
    const uint32_t suns = lightKinds(scene, settings) & 1u << gpu::LIGHT_DIRECTIONAL;
    return suns != 0 && mayLookAtOccluders(scene, settings);
}

bool looksAtShadowMap(const GpuScene& scene, const Estimator& settings) {
    return scene.looksAtShadowMap == true && mayLookAtShadowMap(scene, settings);
}

KernelFeatures seeingFeatures(const GpuScene& scene, const Camera& camera,
                              const Estimator& settings, const DeviceTuning& tuning, Seeing what) {
    Estimator estimator = settings;
    // That of normals asks for what is there, and for no material.
    estimator.integrator = what == Seeing::Coverage ? Integrator::Normals : Integrator::Path;
    estimator.branches = 1;
    estimator.gapProposal = estimator.guidesLight = estimator.aimsAtPortals = false;
    estimator.roulette.mode = Roulette::Mode::None;
    KernelFeatures f = kernelFeatures(scene, camera, estimator, tuning);
    for (const KernelConstant ofLight :
         {SPEC_LIGHT_KINDS, SPEC_MIS_LOBES, SPEC_HAS_EMISSION, SPEC_HAS_AMBIENT,
          SPEC_HAS_ENVIRONMENT, SPEC_HAS_BACKDROP, SPEC_AMBIENT_BY_BOUNCES, SPEC_BLACK_BACKS,
          SPEC_MOST_OTHERS, SPEC_OCCLUDERS, SPEC_SHADOW_MAP})
        f[ofLight] = 0;
    // Colours are seen through media.
    constexpr uint32_t kDimming = gpu::MEDIA_DIM | gpu::MEDIA_VARY | gpu::MEDIA_VARY_EXTINCTION;
    f[SPEC_MEDIA] &= what == Seeing::Surfaces ? kDimming : 0;
    for (const KernelConstant closures : {SPEC_CLOSURES, SPEC_CLOSURES_OF_ALL})
        f[closures] &= ~gpu::VOLUME_ABSORBS;
    f[SPEC_DIRECT_LIGHT] = gpu::DIRECT_LIGHTS;
    f[SPEC_INTEGRATOR] =
        what == Seeing::Coverage ? gpu::INTEGRATOR_COVERAGE : gpu::INTEGRATOR_LAYERS;
    return f;
}

KernelFeatures recordingFeatures(const GpuScene& scene, const Camera& camera,
                                 const Estimator& settings, const DeviceTuning& tuning) {
    KernelFeatures f = kernelFeatures(scene, camera, settings, tuning);
    f[SPEC_RECORDS] = 1;
    return f;
}

// --- Features in words ---------------------------------------------------------------------------

namespace {

FeatureValue bits(std::vector<const char*> names) {
    return {FeatureValue::Kind::Bits, std::move(names)};
}
FeatureValue oneOf(std::vector<const char*> names) {
    return {FeatureValue::Kind::Choice, std::move(names)};
}
FeatureValue count(const char* unit) {
    return {FeatureValue::Kind::Count, {unit}};
}
const FeatureValue flag = {FeatureValue::Kind::Flag, {}};
const FeatureValue share = {FeatureValue::Kind::Share, {}};
const FeatureValue number = {FeatureValue::Kind::Number, {}};

/// By TEXTURE_ slot.
#define NAME_SLOT(name, slot, number, label) label,
const std::vector<const char*> kTextureSlots = {TEXTURE_SLOT_LIST(NAME_SLOT)};
#undef NAME_SLOT

/// By bit: lobes are the first ones of closures.
#define NAME_CLOSURE(name, bit, label) label,
const std::vector<const char*> kClosures = {CLOSURE_LIST(NAME_CLOSURE)};
#undef NAME_CLOSURE
#define NAME_DEPARTURE(bit, member, name, otherwise) otherwise,
const std::vector<const char*> kDepartures = {CONVENTION_LIST(NAME_DEPARTURE)};
#undef NAME_DEPARTURE
#define NAME_MEDIA(name, bit, label) label,
const std::vector<const char*> kMedia = {MEDIA_LIST(NAME_MEDIA)};
#undef NAME_MEDIA
const std::vector<const char*> kLobes(kClosures.begin(),
                                      kClosures.begin() + std::popcount(gpu::LOBE_MASK));

#define NAME_LIGHT(name, number, rows, label) label,
const std::vector<const char*> kLights = {LIGHT_LIST(NAME_LIGHT)};
#undef NAME_LIGHT

std::string list(uint32_t bits, const std::vector<const char*>& names) {
    std::string text;
    for (uint32_t i = 0; i < names.size(); ++i)
        if (bits & (1u << i)) text += (text.empty() ? "" : ", ") + std::string(names[i]);
    return text;
}

} // namespace

const std::vector<Feature>& featureTable() {
#define FEATURE_ROW(number, type, name, standard, value, all, label, shown, adds)                  \
    {SPEC_##name, #name, label, shown, adds},
    static const std::vector<Feature> table = {KERNEL_FEATURES(FEATURE_ROW)};
#undef FEATURE_ROW
    return table;
}

std::string valueText(const Feature& feature, uint32_t value) {
    const std::vector<const char*>& names = feature.shown.names;
    switch (feature.shown.kind) {
    case FeatureValue::Kind::Choice:
        return names.at(value);
    case FeatureValue::Kind::Flag:
        return value != 0 ? "" : "none";
    case FeatureValue::Kind::Bits:
        return value != 0 ? list(value, names) : "none";
    case FeatureValue::Kind::Count:
        if (value == 0) return "none";
        return fmt::format("{}{}{}", value, *names[0] ? " " : "", names[0]);
    case FeatureValue::Kind::Share:
        return value != 0 ? fmt::format("{:.0f} %", 100 * double(std::bit_cast<float>(value)))
                          : "none";
    case FeatureValue::Kind::Number:
        return value != 0 ? fmt::format("{:g}", std::bit_cast<float>(value)) : "none";
    }
    return "";
}

std::vector<std::string> describe(const KernelFeatures& features) {
    std::vector<std::string> lines;
    for (const Feature& f : featureTable()) {
        const uint32_t value = features[f.constant];
        const bool isThere = value != 0 || f.shown.kind == FeatureValue::Kind::Choice;
        const std::string text = valueText(f, value);
        if (isThere) lines.push_back(text.empty() ? f.label : fmt::format("{}: {}", f.label, text));
    }
    return lines;
}

} // namespace stromboli

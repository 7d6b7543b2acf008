#include "host/render/settings.hpp"

#include "scene/model/emitters.hpp"

namespace stromboli {
namespace {

/// Near the best of the bundled scenes where more than one pays (docs/theory/estimator.md,
/// "Branches"): a branch's share of the camera ray and first light samples is a tenth to a sixth of
/// its cost then.
constexpr uint32_t kBranches = 4;
/// Camera rays of a pixel for each branch. With fewer the noise at edges and in soft shadows is no
/// longer small beside that of bounces: it falls as n^-1.5, theirs as 1/n, and in a diffuse room
/// they are 1 to 100 at 16.
constexpr uint32_t kLeastSamplesPerBranch = 4;

/// Light samples leave little noise beside that of bounces: not where one sample or bounce
/// stands for all of the sky, or one sample for many lights.
bool directLightIsSmooth(const Scene& scene, const Estimator& estimator) {
    const bool sky = (scene.environment && !scene.environment->isConstant()) ||
                     std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
                         return light.kind == LightKind::Ambient;
                     });
    return samplesLights(estimator.directLight) && !sky &&
           !haveManyTriangles(collectEmitters(scene));
}

} // namespace

uint32_t branchesThatPay(const Scene& scene, const Estimator& estimator, const PathBudget& budget) {
    const bool bounces = estimator.integrator == Integrator::Path && estimator.maxBounces > 1;
    // It counts samples for what it decides, and means paths.
    const bool countsPaths = budget.adaptive.enabled;
    // The weights of samples, which branches share, would be most of the noise.
    if (hasNegativeLobes(estimator.filter)) return 1;
    if (!bounces || countsPaths || !directLightIsSmooth(scene, estimator)) return 1;
    const uint32_t paths = budget.pathsPerPixel();
    uint32_t branches = kBranches;
    while (branches > 1 &&
           (paths % branches != 0 || paths / branches < kLeastSamplesPerBranch * branches))
        branches /= 2;
    return branches;
}

} // namespace stromboli

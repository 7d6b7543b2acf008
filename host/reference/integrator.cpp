#include "host/reference/integrator.hpp"

#include "host/reference/bsdf.hpp"
#include "host/reference/sampling.hpp"
#include "host/reference/visible.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::reference {
namespace {

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

/// Beer and Lambert's law. The distance may be infinite.
glm::dvec3 transmittance(const Material* medium, double distance) {
    if (medium == nullptr) return glm::dvec3(1.0);
    const glm::dvec3 a = absorptionInside(*medium);
    glm::dvec3 left(1.0);
    for (int c = 0; c < 3; ++c)
        if (a[c] > 0) left[c] = std::exp(-a[c] * distance);
    return left;
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();

} // namespace

PathSample::PathSample(const World& world, const Estimator& settings, const RandomStream& random)
    : world_(world), settings_(settings), random_(random), passes_(random.apart()) {}

glm::dvec3 PathSample::radiance(const Ray& cameraRay) {
    if (!arriveFromCamera(cameraRay)) { // ambient light is not a backdrop
        if (settings_.minBounce == 0 && settings_.showsBackdrop)
            radiance_ += world_.lights.backdrop(cameraRay.direction);
        return radiance_;
    }
    if (settings_.minBounce == 0) addEmission();
    follow(1, settings_.branches > 1);
    return radiance_;
}

void PathSample::follow(uint32_t bounce, bool splits) {
    for (; bounce <= settings_.maxBounces; ++bounce) {
        if (surface_.material->isBlackBehind && isSeenFromBehind(surface_)) return;
        faceForward(surface_, world_.conventions);
        if (world_.hasDetails) applyNormalMap(surface_, world_.scene, world_.conventions);
        if (surface_.material->hasReliefRules() && glm::dot(surface_.shading, surface_.wo) <= 0)
            return;
        if (!survivesFixed()) return;
        const uint32_t lobes = lobesOf(*surface_.material);
        if (scattersIntoManyDirections(lobes) && bounce >= settings_.minBounce) addDirectLight();
        if (splits && scattersAtRandom(lobes)) return followBranches(bounce);
        if (!scatter(bounce)) return;
    }
}

void PathSample::followBranches(uint32_t bounce) {
    const PathSample before = *this;
    radiance_ = {};
    for (uint32_t branch = 0; branch < settings_.branches; ++branch) {
        surface_ = before.surface_;
        medium_ = before.medium_;
        throughput_ = before.throughput_;
        random_ = before.random_.branch(branch, settings_.branches);
        if (scatter(bounce)) follow(bounce + 1, false);
    }
    radiance_ = before.radiance_ + radiance_ / double(settings_.branches);
}

bool PathSample::scatter(uint32_t bounce) {
    const BsdfSample next = sampleBsdf(surface_, random_.threeNumbers(), world_.conventions);
    throughput_ *= next.weight;
    if (!(largest(throughput_) > 0)) return false;
    if (!survivesThroughput(bounce)) return false;

    const bool left = leavesLightsToBounces(*surface_.material) &&
                      samplesLights(settings_.directLight) &&
                      world_.conventions.bouncesFindAllLight;
    const bool counts = emissionCounts(bounce, next.isDelta() || left);
    if (bounce == settings_.maxBounces && !counts) return false;
    medium_ = mediumBeyond(next.transmitted());
    const bool hit =
        next.transmitted()
            ? arrive(transmittedRay(surface_, next.direction), {surface_.triangle})
            : arrive(reflectedRay(surface_, next.direction), {startOfReflected(surface_)});
    if (counts && hit) addEmission();
    if (counts && !hit) radiance_ += throughput_ * world_.lights.ambientRadiance(next.direction);
    return hit;
}

glm::dvec3 PathSample::normalColor(const Ray& cameraRay) {
    return arriveFromCamera(cameraRay) ? 0.5 * surface_.shading + 0.5 : glm::dvec3(0.0);
}

glm::dvec3 PathSample::depth(const Ray& cameraRay) {
    if (!arriveFromCamera(cameraRay)) return glm::dvec3(0.0);
    return glm::dvec3(glm::length(surface_.position - cameraRay.origin));
}

bool PathSample::arriveFromCamera(const Ray& ray) {
    ++rays_;
    return arriveAt(ray, closestForCamera(world_, ray, passes_));
}

bool PathSample::arrive(const Ray& ray, Skip skip) {
    ++rays_;
    return arriveAt(ray, closest(ray, skip));
}

bool PathSample::arriveAt(const Ray& ray, const Hit& hit) {
    const bool misses = hit.primitive == kNoPrimitive;
    throughput_ *= transmittance(medium_, misses ? kInfinite : hit.t);
    if (misses) return false;
    surface_ = surfaceAt(world_.scene, ray, hit);
    drawMaterial(surface_, world_.scene, passes_);
    if (world_.hasDetails) applyTextures(surface_, world_.scene);
    return true;
}

Hit PathSample::closest(const Ray& ray, Skip skip) {
    return closestThere(world_, ray, skip, passes_);
}

double PathSample::shareThatPasses(const Ray& ray, Skip skip) const {
    if (!world_.hasAlpha) return world_.bvh.occluded(ray, skip) ? 0 : 1;
    double left = 1;
    Hit hit;
    while (left > 0) {
        hit = world_.bvh.closestBehind(ray, hit, skip);
        if (hit.primitive == kNoPrimitive) break;
        left *= 1 - opacityAt(world_, hit);
    }
    return left;
}

void PathSample::addEmission() {
    radiance_ += throughput_ * emission(surface_);
}

/// Whether a light that the ray after this scattering finds adds to the picture, or whether direct
/// light has accounted for it.
bool PathSample::emissionCounts(uint32_t bounce, bool delta) const {
    const bool leftToBounces =
        settings_.directLight == DirectLight::Bsdf && world_.conventions.bouncesFindAllLight;
    return bounce >= settings_.minBounce && (delta || leftToBounces);
}

bool PathSample::survivesFixed() {
    if (settings_.roulette.mode != Roulette::Mode::Fixed) return true;
    const double p = settings_.roulette.terminationProbability;
    throughput_ /= 1 - p;
    return random_.next() >= p;
}

bool PathSample::survivesThroughput(uint32_t bounce) {
    if (settings_.roulette.mode != Roulette::Mode::Throughput) return true;
    if (bounce < settings_.roulette.throughputStart) return true;
    const double q = std::min(Roulette::kMaxContinue, Roulette::kBoldness * largest(throughput_));
    throughput_ /= q;
    return random_.next() < q;
}

void PathSample::addDirectLight() {
    lit_ = surface_;
    addDirectLightOfSide();
    if (!isLitFromBehind(*surface_.material)) return;
    lit_.geometric = -surface_.geometric;
    lit_.shading = -surface_.shading;
    lit_.wo = -surface_.wo;
    lit_.lift = 0; // what is transmitted leaves from the flat triangle
    addDirectLightOfSide();
}

bool PathSample::looksBehind() const {
    return glm::dot(lit_.shading, surface_.shading) < 0;
}

bool PathSample::isOfSide(const glm::dvec3& direction) const {
    return !isLitFromBehind(*surface_.material) || glm::dot(lit_.shading, direction) > 0;
}

Ray PathSample::leaveTo(const glm::dvec3& direction) const {
    return looksBehind() ? transmittedRay(surface_, direction) : reflectedRay(surface_, direction);
}

uint32_t PathSample::startOfLightSample() const {
    return looksBehind() ? surface_.triangle : startOfReflected(surface_);
}

const Material* PathSample::mediumBeyond(bool transmitted) const {
    const Material& m = *surface_.material;
    if (!transmitted || !boundsVolume(m)) return medium_;
    return surface_.outside ? surface_.stated : nullptr;
}

void PathSample::addDirectLightOfSide() {
    if (settings_.directLight == DirectLight::Hemisphere) addHemisphereSamples();
    const bool left =
        leavesLightsToBounces(*surface_.material) && world_.conventions.bouncesFindAllLight;
    if (samplesLights(settings_.directLight) && !left) addBroadLights();
    if (!settings_.countsLightsForHemisphere()) addDeltaLights();
}

void PathSample::addBroadLights() {
    const double share = 1.0 / settings_.lightSamples;
    for (size_t light = 0; light < world_.lights.broadCount(); ++light)
        for (uint32_t i = 0; i < settings_.lightSamples; ++i)
            addLightSample(world_.lights.sampleBroad(light, lit_, random_), share);
}

void PathSample::addDeltaLights() {
    for (size_t light = 0; light < world_.lights.deltaCount(); ++light)
        addLightSample(world_.lights.sampleDelta(light, lit_), 1);
}

void PathSample::addLightSample(const LightSample& light, double share) {
    if (!isOfSide(light.direction)) return;
    glm::dvec3 value =
        light.value * evaluateBsdf(surface_, light.direction, world_.conventions).value * share;
    if (!(largest(value) > 0)) return;
    Ray ray = leaveTo(light.direction);
    const double distance = light.infinite ? kInfinite : glm::length(light.target - ray.origin);
    value *= transmittance(mediumBeyond(looksBehind()), distance);
    if (!light.infinite) {
        const glm::dvec3 to = light.target - ray.origin;
        ray.tMax = glm::length(to);
        if (ray.tMax > 0) ray.direction = to / ray.tMax;
    }
    ++rays_;
    radiance_ +=
        throughput_ * value * shareThatPasses(ray, {startOfLightSample(), light.primitive});
}

void PathSample::addHemisphereSamples() {
    const size_t lights = settings_.countsLightsForHemisphere() ? world_.lights.fileCount()
                                                                : world_.lights.broadCount();
    const size_t count = lights * settings_.lightSamples;
    const Frame frame(lit_.shading);
    for (size_t i = 0; i < count; ++i) {
        random_.beginBlock();
        const double u = random_.next(), v = random_.next();
        const glm::dvec3 direction = frame.toWorld(uniformHemisphere(u, v));
        const glm::dvec3 weight =
            evaluateBsdf(surface_, direction, world_.conventions).value * (2 * kPi / double(count));
        if (!(largest(weight) > 0)) continue;
        ++rays_;
        const Ray ray = leaveTo(direction);
        const Hit hit = closest(ray, {startOfLightSample()});
        glm::dvec3 found = world_.lights.ambientRadiance(direction);
        double distance = kInfinite;
        if (hit.primitive != kNoPrimitive) {
            SurfacePoint s = surfaceAt(world_.scene, ray, hit);
            if (world_.hasDetails) applyTextures(s, world_.scene);
            found = emission(s);
            distance = hit.t;
        }
        radiance_ +=
            throughput_ * weight * found * transmittance(mediumBeyond(looksBehind()), distance);
    }
}

} // namespace stromboli::reference

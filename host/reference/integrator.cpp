#include "host/reference/integrator.hpp"

#include "host/reference/bsdf.hpp"
#include "host/reference/medium.hpp"
#include "host/reference/sampling.hpp"
#include "shaders/shared/medium_types.h"

#include <cmath>
#include <limits>

namespace stromboli::reference {

namespace {

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

} // namespace

glm::dvec3 transmittance(const Material* volume, double distance) {
    if (volume == nullptr) return glm::dvec3(1.0);
    const glm::dvec3 a = absorptionInside(*volume);
    glm::dvec3 left(1.0);
    for (int c = 0; c < 3; ++c)
        if (a[c] > 0) left[c] = std::exp(-a[c] * distance);
    return left;
}

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A point of a ray in a medium, as a surface without normals that reflects nothing by itself.
SurfacePoint pointInMedium(const Ray& ray, double t, const Medium& medium) {
    static const Material kBlack = [] {
        Material m;
        m.albedo = glm::vec3(0.0f);
        return m;
    }();
    SurfacePoint s;
    s.position = ray.origin + t * ray.direction;
    s.geometric = s.shading = glm::dvec3(0.0);
    s.wo = -ray.direction;
    s.material = s.stated = &kBlack;
    s.medium = &medium;
    return s;
}

} // namespace

World::World(const Scene& s, const ShadingConventions& c)
    : scene(s), conventions(c), bvh(s), lights(s, c),
      hasDetails(!s.textures.empty() || !s.attributes.empty()),
      hasAlpha(std::ranges::any_of(s.materials,
                                   [](const Material& m) {
                                       return m.alphaMode != AlphaMode::Opaque ||
                                              m.isHiddenFromCamera;
                                   })),
      mediaShine(std::ranges::any_of(s.media, &Medium::emits)),
      hasWalks(std::ranges::any_of(s.media, &Medium::isUnderSurface)), foci(lightFoci(s)) {
    for (const Medium& m : s.media)
        mostExtinction.push_back(reference::mostExtinction(m));
}

PathSample::PathSample(const World& world, const Estimator& settings, const RandomStream& random)
    : world_(world), settings_(settings), random_(random), passes_(random.apart()) {}

glm::dvec3 PathSample::radiance(const Ray& cameraRay, uint32_t medium) {
    if (medium != kNoMedium) filling_ = fillingOf(&world_.scene.media.at(medium));
    const bool hits = arriveFromCamera(cameraRay);
    glm::dvec3 light(0.0);
    if (settings_.minBounce == 0 && hits) light = throughput_ * emission(surface_);
    if (settings_.minBounce == 0 && !hits && settings_.showsBackdrop) // not ambient light
        light = throughput_ * world_.lights.backdrop(cameraRay.direction);
    radiance_ += light;
    noteArrival(cameraRay, hits, light);
    if (!hits) return radiance_;
    follow(numberAfter(0), settings_.branches > 1);
    return radiance_;
}

void PathSample::follow(uint32_t bounce, bool splits) {
    for (; bounce <= settings_.maxBounces; bounce = numberAfter(bounce)) {
        if (isUnderSurface() && ++uncounted_ > gpu::MOST_UNDER_SURFACE) return;
        if (!surface_.medium) {
            if (surface_.material->isBlackBehind && isSeenFromBehind(surface_)) return;
            faceForward(surface_, world_.conventions);
            if (world_.hasDetails) applyNormalMap(surface_, world_.scene, world_.conventions);
            if (surface_.material->hasReliefRules() && glm::dot(surface_.shading, surface_.wo) <= 0)
                return;
        }
        if (!survivesFixed()) return;
        const uint32_t lobes = lobesOf(surface_);
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
        filling_ = before.filling_;
        throughput_ = before.throughput_;
        uncounted_ = before.uncounted_;
        random_ = before.random_.branch(branch, settings_.branches);
        branch_ = branch + 1;
        if (branch > 0) noteReturn();
        if (scatter(bounce)) follow(numberAfter(bounce), false);
    }
    radiance_ = before.radiance_ + radiance_ / double(settings_.branches);
}

bool PathSample::scatter(uint32_t bounce) {
    const BsdfSample next = sampleBsdf(surface_, random_.threeNumbers(), world_.conventions);
    throughput_ *= next.weight;
    const bool survives = largest(throughput_) > 0 && survivesThroughput(bounce);
    noteBounce(next, goesOn_, survives);
    if (!survives) return false;

    const glm::dvec3 found = shareFound(bounce, next);
    if (bounce == settings_.maxBounces && !(largest(found) > 0) && !world_.mediaShine &&
        !world_.hasWalks)
        return false;
    filling_ = beyond(next.transmitted());
    scatterings_ = bounce;
    const Ray ray = next.transmitted() ? rayThroughMedia(world_.scene, surface_, next.direction)
                                       : reflectedRay(surface_, next.direction);
    const uint32_t start = next.transmitted() ? surface_.triangle : startOfReflected(surface_);
    const bool hit = arrive(ray, {start});
    glm::dvec3 light(0.0);
    if (largest(found) > 0)
        light =
            limited(throughput_ * found *
                        (hit ? emission(surface_) : world_.lights.ambientRadiance(next.direction)),
                    bounce);
    radiance_ += light;
    noteArrival(ray, hit, light);
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
    if (!world_.scene.media.empty()) return travel(ray, {}, true);
    return arriveAt(ray, closestForCamera(world_, ray, passes_));
}

bool PathSample::arrive(const Ray& ray, Skip skip) {
    ++rays_;
    if (!world_.scene.media.empty()) return travel(ray, skip, false);
    return arriveAt(ray, closest(ray, skip));
}

bool PathSample::arriveAt(const Ray& ray, const Hit& hit) {
    const bool misses = hit.primitive == kNoPrimitive;
    throughput_ *= transmittance(filling_.volume, misses ? kInfinite : hit.t);
    if (misses) return false;
    surface_ = surfaceAt(world_.scene, ray, hit);
    drawMaterial(surface_, world_.scene, passes_);
    if (world_.hasDetails) applyTextures(surface_, world_.scene);
    return true;
}

bool PathSample::travel(const Ray& ray, Skip skip, bool fromCamera) {
    Hit hit;
    double from = ray.tMin;
    Crossing crossing(filling_);
    while (true) {
        hit = world_.bvh.closestBehind(ray, hit, skip);
        const bool misses = hit.primitive == kNoPrimitive;
        if (scattersInMedium(ray, from, misses ? kInfinite : hit.t)) return true;
        if (misses) return false;
        const bool isHidden = fromCamera && isHiddenFromCamera(world_.scene, hit);
        const SurfacePoint met = surfaceAt(world_.scene, ray, hit);
        if (!isHidden && passes_.next() < opacityAt(world_, hit)) {
            filling_ = crossing.arrive(ray, met, from, hit.t, filling_);
            return arriveAt(ray, hit);
        }
        filling_ = crossing.pass(world_.scene, ray, met, from, hit.t, filling_);
        from = hit.t;
    }
}

bool PathSample::scattersInMedium(const Ray& ray, double from, double to) {
    if (!filling_.medium) return false;
    const auto number = size_t(filling_.medium - world_.scene.media.data());
    const bool samples = samplesLights(settings_.directLight);
    const MediumEvent event =
        flyThrough(*filling_.medium, world_.mostExtinction[number], ray, from, to, throughput_,
                   samples ? &world_.foci : nullptr, passes_);
    if (scatterings_ >= settings_.minBounce)
        radiance_ += limited(throughput_ * event.shone, scatterings_);
    throughput_ *= event.weight;
    if (event.scatters) surface_ = pointInMedium(ray, event.distance, *filling_.medium);
    return event.scatters;
}

Hit PathSample::closest(const Ray& ray, Skip skip) {
    return closestThere(world_, ray, skip, passes_);
}

glm::dvec3 PathSample::shareThatPasses(const Ray& ray, Skip skip, Filling filling) const {
    const bool hasMedia = !world_.scene.media.empty();
    if (!world_.hasAlpha && !hasMedia)
        return glm::dvec3(world_.bvh.occluded(ray, skip) ? 0.0 : 1.0);
    glm::dvec3 left(1.0);
    Hit hit;
    double from = ray.tMin;
    Crossing crossing(filling);
    while (largest(left) > 0) {
        hit = world_.bvh.closestBehind(ray, hit, skip);
        const bool misses = hit.primitive == kNoPrimitive;
        if (filling.medium)
            left *= transmittance(*filling.medium, ray, from, misses ? ray.tMax : hit.t);
        if (misses) break;
        left *= 1 - opacityAt(world_, hit);
        if (hasMedia)
            filling = crossing.pass(world_.scene, ray, surfaceAt(world_.scene, ray, hit), from,
                                    hit.t, filling);
        from = hit.t;
    }
    return left;
}

/// Direct light has accounted for the rest.
glm::dvec3 PathSample::shareFound(uint32_t bounce, const BsdfSample& next) const {
    if (bounce < settings_.minBounce) return glm::dvec3(0.0);
    if (next.isDelta()) return glm::dvec3(1.0);
    if (!world_.conventions.bouncesFindAllLight) return glm::dvec3(0.0);
    if (settings_.directLight == DirectLight::Bsdf) return glm::dvec3(1.0);
    return samplesLights(settings_.directLight) ? next.left : glm::dvec3(0.0);
}

bool PathSample::survivesFixed() {
    if (settings_.roulette.mode != Roulette::Mode::Fixed) return true;
    const double p = settings_.roulette.terminationProbability;
    throughput_ /= 1 - p;
    return random_.next() >= p;
}

bool PathSample::survivesThroughput(uint32_t bounce) {
    goesOn_ = 1;
    if (settings_.roulette.mode != Roulette::Mode::Throughput) return true;
    if (bounce + uncounted_ < settings_.roulette.throughputStart) return true;
    const double q = std::min(1.0, Roulette::kBoldness * largest(throughput_));
    goesOn_ = q;
    throughput_ /= q;
    return random_.next() < q;
}

void PathSample::addDirectLight() {
    lit_ = surface_;
    addDirectLightOfSide();
    if (!isLitFromBehind(surface_)) return;
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
    return !isLitFromBehind(surface_) || glm::dot(lit_.shading, direction) > 0;
}

Ray PathSample::leaveTo(const glm::dvec3& direction) const {
    return looksBehind() ? rayThroughMedia(world_.scene, surface_, direction)
                         : reflectedRay(surface_, direction);
}

uint32_t PathSample::startOfLightSample() const {
    return looksBehind() ? surface_.triangle : startOfReflected(surface_);
}

Filling PathSample::beyond(bool transmitted) const {
    const Material& m = *surface_.material;
    if (!transmitted) return filling_;
    if (m.boundsMedia) return behind(world_.scene, surface_, filling_);
    if (!boundsVolume(m) || !world_.scene.media.empty()) return filling_;
    return {surface_.outside ? surface_.stated : nullptr, nullptr, {}, nullptr};
}

void PathSample::addDirectLightOfSide() {
    if (settings_.directLight == DirectLight::Hemisphere) addHemisphereSamples();
    const bool left = leavesLightsToBounces(surface_) && world_.conventions.bouncesFindAllLight;
    if (samplesLights(settings_.directLight) && !left) addBroadLights();
    if (!settings_.countsLightsForHemisphere()) addDeltaLights();
}

void PathSample::addBroadLights() {
    const double share = 1.0 / settings_.lightSamples;
    const auto evaluate = world_.conventions.bouncesFindAllLight ? evaluateForLights : evaluateBsdf;
    for (size_t light = 0; light < world_.lights.broadCount(); ++light)
        for (uint32_t i = 0; i < settings_.lightSamples; ++i) {
            const LightSample sample = world_.lights.sampleBroad(light, lit_, random_);
            const BsdfValue f = evaluate(surface_, sample.direction, world_.conventions);
            addLightSample(sample, f.value * share);
        }
}

void PathSample::addDeltaLights() {
    for (size_t light = 0; light < world_.lights.deltaCount(); ++light) {
        const LightSample sample = world_.lights.sampleDelta(light, lit_, random_);
        const BsdfValue f = evaluateBsdf(surface_, sample.direction, world_.conventions);
        addLightSample(sample, f.value);
    }
}

void PathSample::addLightSample(const LightSample& light, const glm::dvec3& f) {
    if (!isOfSide(light.direction)) return;
    glm::dvec3 value = light.value * f;
    if (!(largest(value) > 0)) return noteLight(light, RecordedLight::Fate::BringsNothing, value);
    Ray ray = leaveTo(light.direction);
    const double distance = light.infinite ? kInfinite : glm::length(light.target - ray.origin);
    const Filling filling = beyond(looksBehind());
    value *= transmittance(filling.volume, distance);
    if (!light.infinite) {
        const glm::dvec3 to = light.target - ray.origin;
        ray.tMax = glm::length(to);
        if (ray.tMax > 0) ray.direction = to / ray.tMax;
    }
    ++rays_;
    const glm::dvec3 passes =
        shareThatPasses(ray, {startOfLightSample(), light.primitive}, filling);
    const glm::dvec3 brings = limited(throughput_ * value * passes, numberAfter(scatterings_));
    radiance_ += brings;
    noteLight(light,
              largest(passes) > 0 ? RecordedLight::Fate::Arrives : RecordedLight::Fate::InShadow,
              brings);
}

glm::dvec3 PathSample::limited(const glm::dvec3& light, uint32_t scatterings) const {
    const double most = largest(light), limit = settings_.indirectLimit;
    return limit > 0 && scatterings > 1 && most > limit ? light * (limit / most) : light;
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
        const Filling filling = beyond(looksBehind());
        if (filling.medium) found *= transmittance(*filling.medium, ray, 0, distance);
        const glm::dvec3 light =
            limited(throughput_ * weight * found * transmittance(filling.volume, distance),
                    numberAfter(scatterings_));
        radiance_ += light;
        LightSample looked;
        looked.direction = direction;
        noteLight(looked, RecordedLight::Fate::Arrives, light);
    }
}

} // namespace stromboli::reference

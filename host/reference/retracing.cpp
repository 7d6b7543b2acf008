// The path that the kernel has taken, once more in double precision: its directions, densities and
// decisions are taken as they are, and what they meet and bring is worked out anew.
#include "host/reference/integrator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::reference {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// How far a float's path may be off, of a distance.
constexpr double kSameDistance = 1e-3;

/// The kernel divides by no less (recordBounce() in shaders/include/recording.glsl).
constexpr double kLeastRoulette = 0x1p-120; // TINY

bool isNear(double t, double distance) {
    return std::isfinite(distance) && std::abs(t - distance) <= kSameDistance * distance;
}

double largestOf(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

} // namespace

/// Makes the surface there the current one. What is nearer than the kernel's hit is passed if it
/// may be passed.
bool PathSample::arriveWhere(const RecordedVertex& vertex, const Ray& ray, Skip skip,
                             bool fromCamera) {
    Hit hit;
    do {
        hit = world_.bvh.closestBehind(ray, hit, skip);
    } while (hit.primitive != kNoPrimitive && !isNear(hit.t, vertex.distance) &&
             (opacityAt(world_, hit) < 1 || (fromCamera && isHiddenFromCamera(world_.scene, hit))));
    return arriveAt(ray, hit);
}

/// What the surface at a distance along the ray sends back, of all that it meets the one nearest to
/// there; nothing where there is none.
glm::dvec3 PathSample::emissionWhere(const Ray& ray, double distance, uint32_t& emitter) const {
    Hit hit, next;
    do {
        next = world_.bvh.closestBehind(ray, next, {});
        if (next.primitive != kNoPrimitive &&
            std::abs(next.t - distance) < std::abs(hit.t - distance))
            hit = next;
    } while (next.primitive != kNoPrimitive && next.t < distance);
    if (hit.primitive == kNoPrimitive || !isNear(hit.t, distance)) return glm::dvec3(0.0);
    emitter = hit.primitive;
    SurfacePoint s = surfaceAt(world_.scene, ray, hit);
    if (world_.hasDetails) applyTextures(s, world_.scene);
    return emission(s) * opacityAt(world_, hit);
}

/// What a light sample's ray brings that goes on through clear glass, bent, for which no surface is
/// in the way that lets no light through in one direction. skip: of the ray.
glm::dvec3 PathSample::lightThroughGlass(Ray ray, Skip skip) const {
    constexpr int kMostPanes = 64;
    glm::dvec3 left(1.0);
    Filling filling = beyond(looksBehind());
    for (int pane = 0; pane < kMostPanes && largestOf(left) > 0; ++pane) {
        const Hit hit = world_.bvh.closest(ray, skip);
        if (hit.primitive == kNoPrimitive)
            return left * world_.lights.ambientRadiance(ray.direction);
        left *= transmittance(filling.volume, hit.t);
        SurfacePoint s = surfaceAt(world_.scene, ray, hit);
        if (world_.hasDetails) applyTextures(s, world_.scene);
        if (const glm::dvec3 light = emission(s); largestOf(light) > 0) return left * light;
        faceForward(s, world_.conventions);
        if (world_.hasDetails) applyNormalMap(s, world_.scene, world_.conventions);
        constexpr double kLast = 1 - 0x1p-53; // of the numbers that choose a lobe
        const BsdfSample on = sampleBsdf(s, glm::dvec3(kLast), world_.conventions);
        if (on.lobe != gpu::LOBE_DELTA_TRANSMISSION) break;
        left *= on.weight * on.chosen;
        if (boundsVolume(*s.material)) filling.volume = s.outside ? s.material : nullptr;
        ray = transmittedRay(s, on.direction);
        skip = {s.triangle};
    }
    return glm::dvec3(0.0);
}

void PathSample::retraceLight(const RecordedLight& taken) {
    lit_ = surface_;
    if (isLitFromBehind(surface_) && glm::dot(taken.direction, surface_.shading) < 0) {
        lit_.geometric = -surface_.geometric;
        lit_.shading = -surface_.shading;
        lit_.wo = -surface_.wo;
        lit_.lift = 0;
    }
    LightSample light;
    light.direction = taken.direction;
    light.infinite = !std::isfinite(taken.distance);
    Ray ray = leaveTo(taken.direction);
    if (!light.infinite) light.target = litPoint(lit_) + taken.distance * taken.direction;
    glm::dvec3 arriving(0.0);
    if (taken.pdf > 0 && !light.infinite)
        arriving = emissionWhere(ray, taken.distance, light.primitive);
    else if (taken.pdf > 0 && !taken.kind.empty())
        arriving = world_.lights.ambientRadiance(taken.direction);
    else if (taken.pdf > 0) { // hemisphere sampling: whatever is met first
        const Hit hit = world_.bvh.closest(ray, {startOfLightSample()});
        if (hit.primitive == kNoPrimitive)
            arriving = world_.lights.ambientRadiance(taken.direction);
        else
            arriving = emissionWhere(ray, hit.t, light.primitive);
        ray.tMax = hit.t;
    }
    double closest = -1;
    for (size_t i = 0; taken.pdf == 0 && i < world_.lights.deltaCount(); ++i) {
        const LightSample delta = world_.lights.sampleDelta(i, lit_, random_);
        const double cosine = glm::dot(delta.direction, taken.direction);
        if (delta.infinite != light.infinite || cosine < closest) continue;
        closest = cosine;
        arriving = delta.value;
    }
    const double density = taken.pdf > 0 ? taken.pdf : taken.probability;
    const glm::dvec3 f = evaluateBsdf(surface_, taken.direction, world_.conventions).value;
    const glm::dvec3 share = density > 0 ? f * (taken.weight / density) : glm::dvec3(0);
    const glm::dvec3 value = arriving * share;
    RecordedLight::Fate fate = RecordedLight::Fate::BringsNothing;
    glm::dvec3 brings(0.0);
    // A sample that was meant for the other side of a surface is lost, which is no mistake.
    const bool isOfOtherSide =
        isLitFromBehind(surface_) && taken.fate == RecordedLight::Fate::BringsNothing;
    if (largestOf(value) > 0 && !isOfOtherSide) {
        const Filling filling = beyond(looksBehind());
        if (!light.infinite) ray.tMax = taken.distance * (1 - 1e-6);
        ++rays_;
        const glm::dvec3 passes =
            shareThatPasses(ray, {startOfLightSample(), light.primitive}, filling);
        glm::dvec3 found = value * passes * transmittance(filling.volume, taken.distance);
        // Only the kernel's light samples go through glass, in some scenes, and know their light.
        if (!(largestOf(passes) > 0) && taken.fate == RecordedLight::Fate::Arrives) {
            ray.tMax = kInfinite;
            found = share * lightThroughGlass(ray, {startOfLightSample()});
        }
        brings = limited(throughput_ * found, scatterings_ + 1);
        fate = largestOf(found) > 0 ? RecordedLight::Fate::Arrives : RecordedLight::Fate::InShadow;
    }
    radiance_ += brings;
    noteLight(light, fate, brings);
    RecordedLight& noted = record_->vertices.back().lights.back();
    noted.kind = taken.kind;
    noted.pdf = taken.pdf;
    noted.probability = taken.probability;
    noted.weight = taken.weight;
}

/// ray, skip: of the next path ray.
void PathSample::retraceBounce(const RecordedBounce& taken, Ray& ray, Skip& skip) {
    BsdfSample next;
    next.direction = taken.direction;
    next.lobe = taken.lobe;
    if (taken.pdf > 0) {
        const BsdfValue f = evaluateBsdf(surface_, taken.direction, world_.conventions);
        next.pdf = f.pdf;
        next.weight = f.value / taken.pdf;
    } else { // the sample of that lobe that goes there
        constexpr int kTries = 256;
        double best = -1;
        for (int i = 0; i < kTries; ++i) {
            const BsdfSample tried =
                sampleBsdf(surface_, {0.5, 0.5, (i + 0.5) / kTries}, world_.conventions);
            const double cosine = glm::dot(tried.direction, taken.direction);
            if (tried.lobe != taken.lobe || cosine <= best) continue;
            best = cosine;
            next = tried;
        }
    }
    // Roulette that cannot go on has met a path that brings nothing: 0, not 0 / 0.
    throughput_ *= next.weight * (taken.weight / std::max(taken.goesOn, kLeastRoulette));
    noteBounce(next, taken.goesOn, taken.survives && largestOf(throughput_) > 0);
    ray = next.transmitted() ? transmittedRay(surface_, taken.direction)
                             : reflectedRay(surface_, taken.direction);
    skip = {next.transmitted() ? surface_.triangle : startOfReflected(surface_)};
    filling_ = beyond(next.transmitted());
}

RecordedPath PathSample::retrace(const RecordedPath& taken) {
    RecordedPath own = taken;
    own.vertices.clear();
    recordTo(own);
    Ray ray{taken.origin, taken.direction, taken.tMin, kInfinite};
    Skip skip;
    bool fromCamera = true;
    SurfacePoint surface; // where the path splits
    Filling filling;
    glm::dvec3 throughput(1.0);
    uint32_t scatterings = 0;
    for (const RecordedVertex& vertex : taken.vertices) {
        branch_ = vertex.branch;
        if (vertex.returns) {
            surface_ = surface;
            filling_ = filling;
            throughput_ = throughput;
            scatterings_ = scatterings;
            noteReturn();
        } else {
            ++rays_;
            const bool hits = arriveWhere(vertex, ray, skip, fromCamera);
            throughput_ *= vertex.aimedWeight;
            glm::dvec3 light(0.0);
            if (largestOf(vertex.light) > 0) // else it is found by light samples
                light = limited(throughput_ * vertex.weight *
                                    (hits         ? emission(surface_)
                                     : fromCamera ? world_.lights.backdrop(ray.direction)
                                                  : world_.lights.ambientRadiance(ray.direction)),
                                scatterings_);
            noteArrival(ray, hits, light);
            own.vertices.back().weight = vertex.weight;
            own.vertices.back().aimedWeight = vertex.aimedWeight;
            own.vertices.back().goesOn = vertex.goesOn;
            if (!hits) continue;
            faceForward(surface_, world_.conventions);
            if (world_.hasDetails) applyNormalMap(surface_, world_.scene, world_.conventions);
            throughput_ /= vertex.goesOn;
        }
        fromCamera = false;
        for (const RecordedLight& light : vertex.lights)
            retraceLight(light);
        if (vertex.branch == 0) {
            surface = surface_;
            filling = filling_;
            throughput = throughput_;
            scatterings = scatterings_;
        }
        if (vertex.bounce) {
            retraceBounce(*vertex.bounce, ray, skip);
            ++scatterings_;
        }
    }
    own.radiance = sumOf(own);
    own.rejected = false;
    return own;
}

} // namespace stromboli::reference

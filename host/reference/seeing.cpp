// What rays pass, and what the camera sees (docs/guide/layers.md).
#include "host/reference/integrator.hpp"

#include "host/reference/medium.hpp"
#include "scene/model/surface_lookup.hpp"
#include "shaders/shared/layer_types.h"

#include <algorithm>

namespace stromboli::reference {

namespace {

/// Whether what is seen there is another surface.
bool isSeenThrough(const Material& m) {
    if (m.kind == MaterialKind::Principled)
        return m.principled.roughness == 0 &&
               (m.principled.metallic == 1 || m.principled.transmission == 1);
    return m.isDelta();
}

/// The colour that a mirror or glass gives to what is seen there: without what refraction does to
/// radiance.
glm::dvec3 tintOf(const Material& m, const BsdfSample& next) {
    const bool isBlack = next.weight == glm::dvec3(0.0);
    if (next.lobe != gpu::LOBE_DELTA_TRANSMISSION || isBlack) return next.weight;
    return m.kind == MaterialKind::Principled ? m.principled.baseColor : m.transmittance;
}

/// The colour of a surface in white light, apart from what its gloss adds.
glm::dvec3 albedoOf(const Material& m) {
    if (m.kind != MaterialKind::Conductor) return m.baseColor() ? *m.baseColor() : m.albedo;
    const glm::dvec3 eta(m.eta), k(m.k), less = eta - 1.0, more = eta + 1.0;
    const glm::dvec3 atNormal = (less * less + k * k) / (more * more + k * k);
    return glm::dvec3(m.reflectance) * atNormal;
}

/// The surface as it is shaded.
SurfacePoint shadedSurface(const World& world, const Ray& ray, const Hit& hit) {
    SurfacePoint s = surfaceAt(world.scene, ray, hit);
    takeMaterialOfSide(s, world.scene);
    if (world.hasDetails) applyTextures(s, world.scene);
    faceForward(s, world.conventions);
    if (world.hasDetails) applyNormalMap(s, world.scene, world.conventions);
    return s;
}

void noteFirst(SeenPixel& pixel, const SurfacePoint& s, const Hit& hit) {
    pixel.position += s.position;
    if (pixel.hits > 1) return;
    pixel.primitive = hit.primitive;
    pixel.b1 = hit.b1;
    pixel.b2 = hit.b2;
}

/// Calls pass(hit) for one hit after the other, until it is false of one; that one, or none.
template <class Pass>
Hit firstNotPassed(const World& world, const Ray& ray, Skip skip, const Pass& pass) {
    if (!world.hasAlpha) return world.bvh.closest(ray, skip);
    Hit hit;
    do {
        hit = world.bvh.closestBehind(ray, hit, skip);
    } while (hit.primitive != kNoPrimitive && pass(hit));
    return hit;
}

} // namespace

bool isHiddenFromCamera(const Scene& scene, const Hit& hit) {
    const size_t triangles = scene.triangles.size();
    const uint32_t material = hit.primitive < triangles
                                  ? scene.triangles[hit.primitive].material
                                  : scene.spheres[hit.primitive - triangles].material;
    return scene.materials[material].isHiddenFromCamera;
}

double opacityAt(const World& world, const Hit& hit) {
    const Scene& scene = world.scene;
    const size_t triangles = scene.triangles.size();
    if (hit.primitive >= triangles) {
        const Sphere& sphere = scene.spheres[hit.primitive - triangles];
        return stromboli::opacityAt(scene, scene.materials[sphere.material], {});
    }
    const Material& material = scene.materials[scene.triangles[hit.primitive].material];
    return stromboli::opacityAt(scene, material,
                                attributesAt(scene, hit.primitive, hit.b1, hit.b2));
}

Hit closestThere(const World& world, const Ray& ray, Skip skip, RandomStream& passes) {
    return firstNotPassed(world, ray, skip,
                          [&](const Hit& hit) { return passes.next() >= opacityAt(world, hit); });
}

Hit closestForCamera(const World& world, const Ray& ray, RandomStream& passes) {
    return firstNotPassed(world, ray, {}, [&](const Hit& hit) {
        return isHiddenFromCamera(world.scene, hit) || passes.next() >= opacityAt(world, hit);
    });
}

namespace {

/// What the media of a way leave of what is seen, and the share of their own colour in it.
class Haze {
  public:
    Haze(const World& world, uint32_t medium) : scene_(world.scene) {
        if (medium != kNoMedium) here_ = fillingOf(&scene_.media.at(medium));
    }

    /// To the hit, on a ray that begins at `from` or has passed something there.
    void goTo(const Ray& ray, double from, const Hit& hit) {
        if (!here_.medium) return;
        const Medium& m = *here_.medium;
        const double to = hit.primitive == kNoPrimitive ? ray.tMax : hit.t;
        const glm::dvec3 left = transmittance(m, ray, from, to);
        const glm::dvec3 extinction(m.extinction());
        for (int c = 0; c < 3; ++c)
            if (extinction[c] > 0)
                ownColor[c] += tint[c] * (1 - left[c]) * double(m.scattering[c]) / extinction[c];
        tint *= left;
    }
    void begin() { crossing_ = Crossing(here_); }
    void pass(const Ray& ray, double from, const Hit& hit) {
        here_ = crossing_.pass(scene_, ray, surfaceAt(scene_, ray, hit), from, hit.t, here_);
    }
    void arrive(const Ray& ray, double from, const Hit& hit) {
        here_ = crossing_.arrive(ray, surfaceAt(scene_, ray, hit), from, hit.t, here_);
    }
    void enter(const SurfacePoint& s) { here_ = behind(scene_, s, here_); }

    glm::dvec3 tint{1.0}, ownColor{0.0};

  private:
    const Scene& scene_;
    Filling here_;
    Crossing crossing_{Filling()};
};

} // namespace

void addSeen(SeenPixel& pixel, const World& world, const Ray& cameraRay, uint32_t medium,
             double weight, RandomStream random, Seeing what) {
    RandomStream passes = random.apart();
    Haze haze(world, medium);
    const bool hasMedia = !world.scene.media.empty() && what == Seeing::Surfaces;
    const auto follow = [&](const Ray& ray, Skip skip, bool fromCamera) {
        double from = ray.tMin;
        haze.begin();
        const Hit end = firstNotPassed(world, ray, skip, [&](const Hit& hit) {
            const bool isHidden = fromCamera && isHiddenFromCamera(world.scene, hit);
            const bool passed = isHidden || passes.next() >= opacityAt(world, hit);
            if (passed && hasMedia)
                haze.goTo(ray, from, hit), haze.pass(ray, from, hit), from = hit.t;
            return passed;
        });
        if (hasMedia) haze.goTo(ray, from, end);
        if (hasMedia && end.primitive != kNoPrimitive) haze.arrive(ray, from, end);
        return end;
    };
    ++pixel.samples;
    Ray ray = cameraRay;
    Hit hit = follow(ray, {}, true);
    pixel.transmittance += haze.tint;
    if (hit.primitive == kNoPrimitive) {
        pixel.albedo += haze.ownColor;
        return;
    }
    ++pixel.hits;
    pixel.covered += weight;
    if (what == Seeing::Coverage) return;

    SurfacePoint s = shadedSurface(world, ray, hit);
    noteFirst(pixel, s, hit);
    glm::dvec3 normal = s.shading;
    for (uint32_t mirrors = 0;; ++mirrors) {
        if (!isSeenThrough(*s.material)) {
            haze.tint *= albedoOf(*s.material);
            normal = s.shading;
            break;
        }
        if (mirrors == gpu::MOST_SEEN_THROUGH) break;
        const BsdfSample next = sampleBsdf(s, random.threeNumbers(), world.conventions);
        haze.tint *= tintOf(*s.material, next);
        if (!(std::max({haze.tint.x, haze.tint.y, haze.tint.z}) > 0)) break;
        if (next.transmitted()) haze.enter(s);
        ray = next.transmitted() ? rayThroughMedia(world.scene, s, next.direction)
                                 : reflectedRay(s, next.direction);
        hit = follow(ray, {next.transmitted() ? s.triangle : startOfReflected(s)}, false);
        if (hit.primitive == kNoPrimitive) break;
        s = shadedSurface(world, ray, hit);
    }
    pixel.albedo += glm::clamp(haze.tint, 0.0, 1.0) + haze.ownColor;
    pixel.normal += normal;
}

} // namespace stromboli::reference

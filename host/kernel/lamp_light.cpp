#include "host/kernel/lamp_light.hpp"

#include "scene/model/emitters.hpp"

#include <algorithm>
#include <bit>
#include <numbers>

namespace stromboli {
namespace {

/// Surfaces of glass that a ray of light goes through at most.
constexpr int kMostPanes = 16;
/// Glass belongs to a lamp if it is at most so many times as far from where the light starts as the
/// glass before it: the two sides of a globe, or a bulb in a shade, but not a window across the
/// room.
constexpr float kShellRatio = 4;
/// Rays of a lamp by which it is found to be in glass. What they miss, such as a narrow opening,
/// lets few light samples through.
constexpr int kRaysOfLamp = 64;

double meanOf(const glm::vec3& color) {
    return (double(color.x) + color.y + color.z) / 3;
}

/// A parallelogram or a sphere.
bool hasSurface(const LightTable& lights, uint32_t light) {
    const auto header =
        structureAt<gpu::LightHeader>(lights.lights, size_t(gpu::LIGHT_ROWS) * light);
    const uint32_t kind = header.kind & gpu::LIGHT_KIND_MASK;
    return kind == gpu::LIGHT_QUAD || kind == gpu::LIGHT_SPHERE;
}

Lamp lampOfRows(const LightTable& lights, uint32_t light) {
    const size_t row = size_t(gpu::LIGHT_ROWS) * light;
    const auto header = structureAt<gpu::LightHeader>(lights.lights, row);
    Lamp lamp;
    lamp.bothSides = (header.kind & gpu::LIGHT_BOTH_SIDES) != 0;
    if ((header.kind & gpu::LIGHT_KIND_MASK) == gpu::LIGHT_SPHERE) {
        const auto sphere = structureAt<gpu::SphereLight>(lights.lights, row + 1);
        lamp.corner = sphere.center, lamp.radius = sphere.radius;
        lamp.power = meanOf(header.color) * 4 * std::numbers::pi * lamp.radius * lamp.radius;
        return lamp;
    }
    const auto quad = structureAt<gpu::QuadLight>(lights.lights, row + 1);
    lamp.corner = quad.corner, lamp.edgeA = quad.edgeA, lamp.edgeB = quad.edgeB;
    lamp.power = meanOf(header.color) * quad.area * (lamp.bothSides ? 2 : 1);
    return lamp;
}

/// The lamp that the triangle or the sphere at a place is.
Lamp lampOfPrimitive(const WideLayout& bvh, uint32_t place, double radiance, bool bothSides) {
    Lamp lamp;
    lamp.bothSides = bothSides;
    if (const std::optional<PlacedCorners> c = placedCorners(bvh, place)) {
        lamp.corner = c->v0, lamp.edgeA = c->v1 - c->v0, lamp.edgeB = c->v2 - c->v0;
        lamp.isTriangle = true;
        lamp.power = radiance * c->area() * (bothSides ? 2 : 1);
    } else {
        const PlacedSphere sphere = placedSphere(bvh, place);
        lamp.corner = sphere.center, lamp.radius = sphere.radius;
        lamp.power = radiance * 4 * std::numbers::pi * sphere.radius * sphere.radius;
    }
    return lamp;
}

Landed landed(const GpuScene& scene, const TraversalRay& ray, const TraversalHit& hit) {
    if (!hit) return {};
    const bool isLamp = meanOf(materialAtPlace(scene, hit.primitive).emission) > 0;
    if (isLamp) return {};
    Landed at;
    at.b1 = hit.b1, at.b2 = hit.b2;
    const glm::dvec3 direction(ray.direction);
    if (const std::optional<PlacedCorners> c = placedCorners(scene.bvh, hit.primitive)) {
        if (!(c->area() > 0)) return {};
        at.normal = c->normal();
        at.point = c->v0 + double(hit.b1) * (c->v1 - c->v0) + double(hit.b2) * (c->v2 - c->v0);
    } else {
        at.point = glm::dvec3(ray.origin) + double(hit.t) * direction;
        at.normal = glm::normalize(at.point - placedSphere(scene.bvh, hit.primitive).center);
    }
    if (glm::dot(at.normal, direction) > 0) at.normal = -at.normal;
    at.place = hit.primitive;
    return at;
}

/// Glass, clear or frosted: light goes through it, and more or less straight on.
bool isGlass(const gpu::MaterialHeader& m) {
    return (m.closures & (gpu::LOBE_DELTA_TRANSMISSION | gpu::LOBE_GLOSSY_TRANSMISSION)) != 0 &&
           (m.closures & gpu::LOBE_DIFFUSE_TRANSMISSION) == 0;
}

/// Smooth glass without a picture or gaps. A light sample's ray ends at it, and none is taken on it
/// that would bring anything, as it scatters light into single directions.
bool isClearGlass(const Material& m) {
    if (m.alphaMode != AlphaMode::Opaque || m.other != kNoMaterial || m.emits()) return false;
    switch (m.kind) {
    case MaterialKind::Refraction:
    case MaterialKind::ThinDielectric:
        return true;
    case MaterialKind::Dielectric:
        return m.isSmooth();
    case MaterialKind::Principled:
        return m.isSmooth() && m.textures.empty();
    default:
        return false;
    }
}

class GlassAboutLamps {
  public:
    GlassAboutLamps(const Scene& scene, const WideLayout& bvh) : scene_(scene), bvh_(bvh) {
        for (const Material& m : scene.materials)
            isClear_.push_back(isClearGlass(m));
    }

    bool isAnywhere() const { return std::ranges::find(isClear_, true) != isClear_.end(); }

    bool isAbout(const Emitter& emitter) {
        std::vector<Lamp> lamps;
        for (const uint32_t t : emitter.triangles)
            lamps.push_back(lampOf(t, emitter));
        if (emitter.kind == EmitterKind::Sphere)
            lamps.push_back(lampOf(sphereId(emitter), emitter));
        std::erase_if(lamps, [](const Lamp& l) { return !(l.power > 0); });
        if (lamps.empty()) return false;
        float farthestGlass = 0, farthestOther = 0;
        size_t toGlass = 0, toOther = 0;
        for (const TraversalRay& ray : raysOfLamps(lamps, kRaysOfLamp, random_)) {
            const TraversalHit hit = closestHit(bvh_, ray);
            if (!hit) return false;
            if (scene_.materials[materialOf(hit)].emits()) continue; // its own other side
            const bool isGlass = isClear_[materialOf(hit)];
            ++(isGlass ? toGlass : toOther);
            float& farthest = isGlass ? farthestGlass : farthestOther;
            farthest = std::max(farthest, hit.t);
        }
        return toGlass > toOther && farthestOther <= farthestGlass;
    }

    uint32_t sphereId(const Emitter& emitter) const {
        return uint32_t(scene_.triangles.size()) + emitter.sphere;
    }

  private:
    uint32_t materialOf(const TraversalHit& hit) const {
        return materialNumberAt(scene_, bvh_, hit.primitive);
    }

    /// All of an emitter is of one material: what it shines with does not matter.
    Lamp lampOf(uint32_t id, const Emitter& emitter) const {
        return lampOfPrimitive(bvh_, bvh_.placeOf[id], 1,
                               scene_.materials[emitter.material].emitsBothSides);
    }

    const Scene& scene_;
    const WideLayout& bvh_;
    std::vector<bool> isClear_; ///< by material
    Random random_{31};
};

} // namespace

void goThrough(const WideLayout& bvh, TraversalRay& ray, const TraversalHit& hit) {
    // A triangle is left out by its place, a sphere by the rounding of its distance.
    const bool isTriangle = placedCorners(bvh, hit.primitive).has_value();
    ray.tMin = isTriangle ? hit.t : hit.t * (1 + 0x1p-16f);
    ray.skipPrimitive = isTriangle ? hit.primitive : gpu::NO_PRIMITIVE;
}

std::optional<PlacedCorners> placedCorners(const WideLayout& bvh, uint32_t place) {
    TraversalHit hit;
    hit.primitive = place;
    const auto c = cornersAt(bvh, hit);
    if (!c) return std::nullopt;
    return PlacedCorners{(*c)[0], (*c)[1], (*c)[2]};
}

PlacedSphere placedSphere(const WideLayout& bvh, uint32_t place) {
    const gpu::LeafRecord leaf = asLeaf(bvh.records[place / 2]);
    return {leaf.p0, double(std::bit_cast<float>(leaf.homeOrRadius))};
}

gpu::MaterialHeader materialAtPlace(const GpuScene& scene, uint32_t place) {
    const gpu::LeafRecord leaf = asLeaf(scene.bvh.records[place / 2]);
    const uint32_t first = leaf.primitive & gpu::RECORD_INDEX_MASK;
    return materialHeader(scene, scene.primitives[first + place % 2]);
}

bool isClearAtPlace(const GpuScene& scene, uint32_t place) {
    return (materialAtPlace(scene, place).closures & gpu::LOBE_DELTA_TRANSMISSION) != 0;
}

uint32_t materialNumberAt(const Scene& scene, const WideLayout& bvh, uint32_t place) {
    const gpu::LeafRecord leaf = asLeaf(bvh.records[place / 2]);
    const uint32_t first = leaf.primitive & gpu::RECORD_INDEX_MASK;
    const uint32_t id = bvh.primitiveOrder[first + place % 2];
    const size_t triangles = scene.triangles.size();
    return id < triangles ? scene.triangles[id].material : scene.spheres[id - triangles].material;
}

Lamp lampAtPlace(const GpuScene& scene, uint32_t place) {
    const gpu::MaterialHeader m = materialAtPlace(scene, place);
    return lampOfPrimitive(scene.bvh, place, meanOf(m.emission),
                           (m.closures & gpu::MATERIAL_EMITS_BOTH_SIDES) != 0);
}

std::optional<Lamp> lampOfLight(const GpuScene& scene, uint32_t number) {
    const uint32_t light = structureAt<gpu::LightEntry>(scene.lights.table, number).light;
    if (light & gpu::LIGHT_IS_TRIANGLE) return lampAtPlace(scene, light & ~gpu::LIGHT_IS_TRIANGLE);
    if (!hasSurface(scene.lights, light)) return std::nullopt;
    return lampOfRows(scene.lights, light);
}

std::vector<Lamp> sampledLamps(const GpuScene& scene) {
    std::vector<Lamp> lamps;
    for (uint32_t i = 0; i < scene.lights.count; ++i)
        if (const std::optional<Lamp> lamp = lampOfLight(scene, i)) lamps.push_back(*lamp);
    std::erase_if(lamps, [](const Lamp& lamp) { return !(lamp.power > 0); });
    return lamps;
}

std::vector<Lamp> lampsOf(const GpuScene& scene) {
    std::vector<Lamp> lamps = sampledLamps(scene);
    for (const uint32_t primitive : scene.lights.leftToBounces)
        lamps.push_back(lampAtPlace(scene, scene.bvh.placeOf[primitive]));
    std::erase_if(lamps, [](const Lamp& lamp) { return !(lamp.power > 0); });
    return lamps;
}

glm::vec3 aboutNormal(const glm::dvec3& n, Random& random) {
    const glm::dvec3 d = n + glm::dvec3(random.direction());
    const double length = glm::length(d);
    return length > 1e-6 ? glm::vec3(d / length) : glm::vec3(n);
}

LampPoint pointOf(const Lamp& lamp, Random& random) {
    if (lamp.radius > 0) {
        const glm::dvec3 normal(random.direction());
        return {lamp.corner + lamp.radius * normal, normal};
    }
    double u = random.uniform(), v = random.uniform();
    if (lamp.isTriangle && u + v > 1) u = 1 - u, v = 1 - v;
    LampPoint at{lamp.corner + u * lamp.edgeA + v * lamp.edgeB,
                 glm::normalize(glm::cross(lamp.edgeA, lamp.edgeB))};
    if (lamp.bothSides && random.uniform() < 0.5f) at.normal = -at.normal;
    return at;
}

TraversalRay leaveLamp(const Lamp& lamp, Random& random) {
    TraversalRay ray;
    const LampPoint from = pointOf(lamp, random);
    ray.direction = aboutNormal(from.normal, random);
    // Outside of the lamp, whatever the rounding of its corners and of the origin, of 2^-24 each.
    const double size = glm::length(from.point) + lamp.radius + glm::length(lamp.edgeA);
    ray.origin = glm::vec3(from.point + 0x1p-20 * size * from.normal);
    return ray;
}

std::vector<TraversalRay> raysOfLamps(std::span<const Lamp> lamps, size_t count, Random& random) {
    double power = 0;
    for (const Lamp& lamp : lamps)
        power += lamp.power;
    std::vector<TraversalRay> rays;
    double due = 0;
    for (const Lamp& lamp : lamps)
        for (due += double(count) * lamp.power / power; due >= 1; --due)
            rays.push_back(leaveLamp(lamp, random));
    return rays;
}

LightPath followLight(const GpuScene& scene, const TraversalRay& start) {
    LightPath path;
    TraversalRay ray = start;
    TraversalHit hit;
    float lastShell = 0; ///< distance of the last glass about the lamp
    bool isAboutLamp = true;
    for (int pane = 0; pane < kMostPanes; ++pane) {
        hit = closestHit(scene.bvh, ray);
        if (!hit || !isGlass(materialAtPlace(scene, hit.primitive))) break;
        isAboutLamp = isAboutLamp && (pane == 0 || hit.t <= kShellRatio * lastShell);
        if (isAboutLamp) {
            path.glass = landed(scene, ray, hit);
            lastShell = hit.t;
        }
        goThrough(scene.bvh, ray, hit);
    }
    path.surface = landed(scene, ray, hit);
    return path;
}

std::vector<bool> lampsInGlass(const Scene& scene, const WideLayout& bvh) {
    GlassAboutLamps glass(scene, bvh);
    std::vector<bool> isIn;
    if (!glass.isAnywhere()) return isIn;
    for (const Emitter& e : collectEmitters(scene)) {
        if (!glass.isAbout(e)) continue;
        isIn.resize(scene.triangles.size() + scene.spheres.size());
        for (const uint32_t t : e.triangles)
            isIn[t] = true;
        if (e.kind == EmitterKind::Sphere) isIn[glass.sphereId(e)] = true;
    }
    return isIn;
}

} // namespace stromboli

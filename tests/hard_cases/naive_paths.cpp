// The naive subject's path tracer.
#include "tests/hard_cases/naive_subject.hpp"
#include "tests/hard_cases/naive_surfaces.hpp"

#include <array>
#include <cmath>

namespace stromboli::test::naive {
namespace {

constexpr float kPi = 3.14159265f;
/// In whatever the scene's unit is: not too small, not too large.
constexpr float kEpsilon = 1e-4f;

struct Path {
    const Scene& scene;
    const RenderSettings& settings;
    Random& random;
    uint64_t& rays;
    glm::vec3 position{0.0f}, normal{0.0f}, wo{0.0f}; ///< normal: the shading one, towards wo
    bool outside = true;
    const Material* material = nullptr;
    glm::vec3 emission{0.0f};
    glm::vec3 throughput{1.0f}, radiance{0.0f};

    const Medium* medium = nullptr;

    void absorb(const glm::vec3& origin, const glm::vec3& direction, float from, float to);
    bool arrive(const glm::vec3& origin, const glm::vec3& direction, float tMin);
    bool counts(uint32_t scatterings) const { return scatterings >= settings.estimator.minBounce; }
    void addEmission(uint32_t scatterings);
    void addAmbient(uint32_t scatterings);
    void addSky(const glm::vec3& direction);
    void addSkySample();
    void addEmitters();
    void addEmitter(const glm::vec3& target, const glm::vec3& emitterNormal, const glm::vec3& light,
                    float area, bool bothSides);
    void addDeltaLights();
    bool shadowed(const glm::vec3& direction, float distance);
    glm::vec3 scatter();
};

void Path::absorb(const glm::vec3& origin, const glm::vec3& direction, float from, float to) {
    if (!medium) return;
    float density = 1;
    if (medium->density) {
        const glm::vec3 middle = origin + (from + to) / 2 * direction;
        density = float(medium->density->at(medium->density->place(middle)));
    }
    throughput *= glm::exp(-density * (to - from) * medium->extinction());
}

bool Path::arrive(const glm::vec3& origin, const glm::vec3& direction, float tMin) {
    ++rays;
    float from = 0;
    Hit hit = closest(scene, origin, direction, tMin, stress::kMissed);
    while (hit && hit.material->alphaMode == AlphaMode::Blend &&
           random.uniform() >= hit.material->opacity) {
        absorb(origin, direction, from, hit.t);
        from = hit.t;
        const bool enters = glm::dot(hit.geometric, direction) < 0;
        const uint32_t number = enters ? hit.material->inside : kNoMedium;
        if (hit.material->boundsMedia)
            medium = number == kNoMedium ? nullptr : &scene.media[number];
        hit = closest(scene, origin, direction, hit.t + kEpsilon, stress::kMissed);
    }
    if (!hit) return false;
    absorb(origin, direction, from, hit.t);
    position = origin + hit.t * direction;
    wo = -direction;
    material = hit.material;
    emission = emissionAt(scene, hit);
    outside = glm::dot(hit.shading, wo) > 0;
    normal = outside ? mappedNormal(scene, hit) : -mappedNormal(scene, hit);
    return true;
}

void Path::addEmission(uint32_t scatterings) {
    if (counts(scatterings) && (outside || material->emitsBothSides))
        radiance += throughput * emission;
}

void Path::addAmbient(uint32_t scatterings) {
    for (const Light& light : scene.lights)
        if (light.kind == LightKind::Ambient && counts(scatterings))
            radiance += throughput * light.color;
}

void Path::addSky(const glm::vec3& direction) {
    if (scene.environment) radiance += throughput * skyAlong(*scene.environment, direction);
}

void Path::addSkySample() {
    if (!scene.environment) return;
    const SkySample sky = sampleSky(*scene.environment, random);
    const float cosine = glm::dot(normal, sky.direction);
    if (cosine > 0 && !shadowed(sky.direction, stress::kMissed))
        radiance += throughput * material->albedo / kPi * sky.value * cosine;
}

/// Up to the emitter itself.
bool Path::shadowed(const glm::vec3& direction, float distance) {
    ++rays;
    return bool(closest(scene, position, direction, kEpsilon, distance));
}

void Path::addEmitter(const glm::vec3& target, const glm::vec3& emitterNormal,
                      const glm::vec3& light, float area, bool bothSides) {
    const glm::vec3 d = target - position;
    const float distance = glm::length(d);
    const glm::vec3 w = d / distance;
    const float cosine = glm::dot(normal, w);
    float cosineThere = -glm::dot(emitterNormal, w);
    if (bothSides) cosineThere = std::abs(cosineThere);
    if (cosine <= 0 || cosineThere <= 0 || shadowed(w, distance)) return;
    radiance += throughput * material->albedo / kPi * light * cosine * cosineThere * area /
                (distance * distance);
}

/// One emissive primitive, taken at random.
void Path::addEmitters() {
    std::vector<const Triangle*> triangles;
    std::vector<const Sphere*> spheres;
    for (const Triangle& t : scene.triangles)
        if (scene.materials[t.material].emits()) triangles.push_back(&t);
    for (const Sphere& s : scene.spheres)
        if (scene.materials[s.material].emits()) spheres.push_back(&s);
    const size_t count = triangles.size() + spheres.size();
    if (count == 0) return;
    const size_t chosen = std::min(size_t(random.uniform() * float(count)), count - 1);
    const float u = random.uniform(), v = random.uniform();
    if (chosen < triangles.size()) {
        const Triangle& t = *triangles[chosen];
        const glm::vec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]];
        const glm::vec3 c = scene.positions[t.corner[2]], cross = glm::cross(b - a, c - a);
        const float r = std::sqrt(u);
        const Material& m = scene.materials[t.material];
        addEmitter(a + r * (1 - v) * (b - a) + r * v * (c - a), glm::normalize(cross), m.emission,
                   glm::length(cross) / 2, m.emitsBothSides);
    } else {
        const Sphere& s = *spheres[chosen - triangles.size()];
        const float z = 1 - 2 * u, r = std::sqrt(std::max(1 - z * z, 0.0f));
        const glm::vec3 n(r * std::cos(2 * kPi * v), r * std::sin(2 * kPi * v), z);
        const Material& m = scene.materials[s.material];
        addEmitter(s.center + s.radius * n, n, m.emission, 4 * kPi * s.radius * s.radius,
                   m.emitsBothSides);
    }
}

void Path::addDeltaLights() {
    for (const Light& light : scene.lights) {
        if (light.kind == LightKind::Directional) {
            const float cosine = -glm::dot(normal, light.direction);
            if (cosine > 0 && !shadowed(-light.direction, stress::kMissed))
                radiance += throughput * material->albedo / kPi * light.color * cosine;
        } else if (light.kind == LightKind::Point) {
            const glm::vec3 d = light.position - position;
            const float distance = glm::length(d), cosine = glm::dot(normal, d) / distance;
            if (cosine > 0 && !shadowed(d / distance, distance))
                radiance +=
                    throughput * material->albedo / kPi * light.color * cosine /
                    (light.constantAttenuation + light.quadraticAttenuation * distance * distance);
        }
    }
}

glm::vec3 aroundNormal(const glm::vec3& n, float u, float v) {
    const glm::vec3 other = std::abs(n.x) > 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 x = glm::normalize(glm::cross(n, other)), y = glm::cross(n, x);
    const float r = std::sqrt(u), phi = 2 * kPi * v;
    return r * std::cos(phi) * x + r * std::sin(phi) * y + std::sqrt(1 - u) * n;
}

/// The direction of the next ray; the zero vector if there is none.
glm::vec3 Path::scatter() {
    const float u = random.uniform(), v = random.uniform();
    const glm::vec3 reflected = 2 * glm::dot(wo, normal) * normal - wo;
    if (material->kind == MaterialKind::Diffuse) {
        throughput *= material->albedo;
        return aroundNormal(normal, u, v);
    }
    if (material->kind == MaterialKind::Mirror || material->kind == MaterialKind::Conductor) {
        throughput *= material->reflectance;
        return reflected;
    }
    const PrincipledParameters& principled = material->principled;
    const bool isPrincipled = material->kind == MaterialKind::Principled;
    if (isPrincipled && principled.transmission == 0) {
        const float alpha = principled.roughness * principled.roughness;
        const glm::vec3 half = halfVector(normal, alpha, u, v);
        const glm::vec3 wi = 2 * glm::dot(wo, half) * half - wo;
        throughput *= principled.baseColor * metalWeight(normal, wo, wi, half, alpha);
        return wi;
    }
    const float ior = isPrincipled ? principled.ior : material->ior;
    const float eta = outside ? 1 / ior : ior;
    const float cosine = glm::dot(wo, normal), k = 1 - eta * eta * (1 - cosine * cosine);
    const float r0 = std::pow((1 - ior) / (1 + ior), 2.0f);
    const float schlick = r0 + (1 - r0) * std::pow(1 - cosine, 5.0f);
    if (k < 0 || u < schlick) return reflected;
    throughput *= eta * eta;
    if (isPrincipled) throughput *= principled.attenuationColor;
    return (eta * cosine - std::sqrt(k)) * normal - eta * wo;
}

} // namespace

glm::vec3 radiance(const Scene& scene, const RenderSettings& settings, glm::vec3 origin,
                   glm::vec3 direction, float tMin, Random& random, uint64_t& rays) {
    Path p{scene, settings, random, rays};
    if (!p.arrive(origin, direction, tMin)) {
        p.addSky(direction);
        return p.radiance;
    }
    p.addEmission(0);
    const bool byBounces = !samplesLights(settings.estimator.directLight);
    for (uint32_t k = 1; k <= settings.estimator.maxBounces; ++k) {
        const bool delta = p.material->isDelta() || p.material->kind == MaterialKind::Principled;
        if (!delta && p.counts(k)) {
            if (!byBounces) {
                p.addEmitters();
                p.addSkySample();
            }
            p.addDeltaLights();
        }
        const glm::vec3 next = p.scatter();
        if (settings.estimator.roulette.mode != Roulette::Mode::None && k >= 3 &&
            random.uniform() > p.throughput.x)
            break;
        if (!p.arrive(p.position, next, kEpsilon)) {
            p.addAmbient(k);
            if (byBounces || delta) p.addSky(next);
            break;
        }
        if (byBounces || delta) p.addEmission(k);
    }
    return p.radiance;
}

} // namespace stromboli::test::naive

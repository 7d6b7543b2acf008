#include "host/bench/embree_world.hpp"

#include "host/bench/embree_lights.hpp"

#include <algorithm>
#include <limits>

namespace stromboli::bench {
namespace {

static_assert(native::kRouletteStart == Roulette::kThroughputStart);
static_assert(native::kMostContinue == float(Roulette::kMaxContinue));
static_assert(native::kBoldness == float(Roulette::kBoldness));

native::SurfaceKind kindOf(MaterialKind kind) {
    switch (kind) {
    case MaterialKind::Mirror:
        return native::SurfaceKind::Mirror;
    case MaterialKind::Refraction:
        return native::SurfaceKind::Refraction;
    case MaterialKind::Dielectric:
        return native::SurfaceKind::Glass;
    default:
        return native::SurfaceKind::Diffuse;
    }
}

native::Roulette modeOf(Roulette::Mode mode) {
    switch (mode) {
    case Roulette::Mode::Throughput:
        return native::Roulette::Throughput;
    case Roulette::Mode::Fixed:
        return native::Roulette::Fixed;
    default:
        return native::Roulette::None;
    }
}

/// Left at 0 where the corner normals are not all on one side of the plane.
void setBulges(const Scene& scene, const Triangle& t, native::TriangleShading& shading) {
    const glm::vec3 geometric = scene.geometricNormal(t);
    int before = 0, behind = 0;
    for (const uint32_t n : t.normals) {
        before += glm::dot(scene.normals[n], geometric) > 0;
        behind += glm::dot(scene.normals[n], geometric) < 0;
    }
    const float side = before == 3 ? 1.0f : behind == 3 ? -1.0f : 0.0f;
    for (int i = 0; i < 3; ++i) {
        const int next = (i + 1) % 3;
        shading.bulge[i] =
            side * glm::dot(scene.normals[t.normals[i]] - scene.normals[t.normals[next]],
                            scene.positions[t.corner[i]] - scene.positions[t.corner[next]]);
    }
}

} // namespace

EmbreeWorld::EmbreeWorld(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                         const native::Tracer& tracer) {
    world_.tracer = tracer;
    addSurfaces(scene);
    addGeometry(scene);
    addLights(scene, settings);
    setView(camera);
    setSettings(settings);
}

void EmbreeWorld::addSurfaces(const Scene& scene) {
    for (const Material& m : scene.materials) {
        native::Surface s{};
        s.kind = kindOf(m.kind);
        s.reflectance = plain(m.kind == MaterialKind::Diffuse ? m.albedo : m.reflectance);
        s.emission = plain(m.emission);
        s.emitsBothSides = m.emitsBothSides;
        s.transmittance = plain(m.transmittance);
        s.ior = m.ior;
        surfaces_.push_back(s);
    }
    world_.surfaces = surfaces_.data();
}

void EmbreeWorld::addGeometry(const Scene& scene) {
    const auto note = [&](uint32_t material) {
        if (scene.materials[material].isDelta()) features_ |= native::kHasDeltaSurfaces;
    };
    for (const Triangle& t : scene.triangles) {
        triangles_.push_back({t.material, {t.normals[0], t.normals[1], t.normals[2]}, {}});
        if (t.normals[0] != kNoNormals) {
            features_ |= native::kHasNormals;
            setBulges(scene, t, triangles_.back());
        }
        note(t.material);
    }
    for (const glm::vec3& n : scene.normals)
        normals_.emplace_back(n, 0);
    for (const Sphere& s : scene.spheres) {
        spheres_.push_back({plain(s.center), s.radius, s.material});
        features_ |= native::kHasSpheres;
        note(s.material);
    }
    world_.triangles = triangles_.data();
    world_.normals = normals_.empty() ? nullptr : &normals_[0].x;
    world_.spheres = spheres_.data();
}

void EmbreeWorld::addLights(const Scene& scene, const RenderSettings& settings) {
    lights_ = embreeLights(scene, settings);
    world_.lights = lights_.lights.data();
    world_.triangleLights = lights_.triangles.data();
    world_.lightEntries = lights_.entries.data();
    world_.aliasColumns = lights_.columns.data();
    world_.lightNodes = lights_.nodes.data();
    world_.lightChoice = lights_.choice;
    std::ranges::copy(lights_.lightsInGroup, world_.lightsInGroup);
    world_.lightCount = uint32_t(lights_.entries.size());
    world_.areaLights = lights_.areaLights;
    world_.onlyNearWithoutCones = lights_.onlyNearWithoutCones;
    world_.hasAmbient = lights_.hasAmbient;
    world_.ambientOfBounces = lights_.ambientOfBounces;
    world_.lightSamples = lights_.direct.lights;
    world_.samplesPerLight = lights_.direct.perLight;
    if (!lights_.oneQuad) features_ |= native::kHasOtherLights;
}

void EmbreeWorld::setView(const Camera& camera) {
    native::View& v = world_.view;
    v.orthographic = camera.orthographic;
    v.clipAlongRay = camera.clipAlongRay;
    v.position = plain(glm::vec3(camera.position));
    v.right = plain(glm::vec3(camera.halfWidth * camera.right));
    v.up = plain(glm::vec3(camera.halfHeight * camera.up));
    v.back = plain(glm::vec3(camera.backOfMiddle()));
    v.nearDistance = float(camera.nearDistance);
    v.farDistance = float(std::min(camera.farDistance, double(std::numeric_limits<float>::max())));
}

void EmbreeWorld::setSettings(const RenderSettings& settings) {
    world_.width = settings.area.width;
    world_.height = settings.area.height;
    world_.seed = settings.estimator.seed;
    world_.sobol = settings.estimator.sampler == Sampler::Sobol;
    world_.minBounce = settings.estimator.minBounce;
    world_.maxBounces = settings.estimator.maxBounces;
    world_.roulette = modeOf(settings.estimator.roulette.mode);
    world_.terminationProbability = float(settings.estimator.roulette.terminationProbability);
}

} // namespace stromboli::bench

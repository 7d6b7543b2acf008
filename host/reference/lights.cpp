#include "host/reference/lights.hpp"

#include "host/reference/emitters.hpp"
#include "host/reference/sampling.hpp"
#include "scene/model/mean_emission.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace stromboli::reference {
namespace {

std::vector<double> runningAreas(const Scene& scene, const Emitter& emitter) {
    std::vector<double> sums;
    double sum = 0;
    for (uint32_t index : emitter.triangles) {
        sum += EmitterTriangle(scene, index).area;
        sums.push_back(sum);
    }
    return sums;
}

ManyTriangles asOneLight(const Scene& scene, const std::vector<Emitter>& emitters) {
    const MeanEmission means(scene);
    ManyTriangles many;
    double sum = 0;
    for (const Emitter& emitter : emitters)
        for (const uint32_t index : emitter.triangles) {
            many.triangles.push_back(index);
            many.powers.push_back(means.powerOfTriangle(index));
            many.powerSums.push_back(sum += many.powers.back());
        }
    return many;
}

/// The first entry whose running sum exceeds u times the total: never one without a share.
size_t pickByShare(const std::vector<double>& sums, double u) {
    const auto found = std::upper_bound(sums.begin(), sums.end(), u * sums.back());
    if (found != sums.end()) return size_t(found - sums.begin());
    // u * total was rounded up to the total: the last entry that has a share.
    return size_t(std::lower_bound(sums.begin(), sums.end(), sums.back()) - sums.begin());
}

double attenuation(const Light& light, double distance) {
    return double(light.constantAttenuation) + double(light.linearAttenuation) * distance +
           double(light.quadraticAttenuation) * distance * distance;
}

/// cosine: of the angle between the spot's axis and the way to the surface.
double spotFalloff(const Light& light, double cosine) {
    const double outer = std::cos(double(light.falloffAngle) / 2);
    if (cosine < outer) return 0;
    if (light.innerAngle) {
        const double inner = std::cos(double(*light.innerAngle) / 2);
        const double edge = std::min((cosine - outer) / (inner - outer), 1.0);
        return edge * edge;
    }
    if (light.falloffExponent == 0) return 1;
    return std::pow(std::max(cosine, 0.0), double(light.falloffExponent));
}

/// d: unit, the way the light travels.
glm::dvec3 projected(const Scene& scene, const Light& light, const glm::dvec3& axis,
                     const glm::dvec3& d) {
    const double cosine = glm::dot(axis, d), outer = double(light.falloffAngle) / 2;
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (!(cosine > 0 && angle < outer)) return glm::dvec3(0.0);
    double factor = 1;
    if (light.innerAngle)
        factor = std::min((outer - angle) / (outer - double(*light.innerAngle) / 2), 1.0);
    PointAttributes at;
    at.uv[0] = 0.5 + glm::dvec2(glm::dot(glm::dvec3(light.edgeX), d),
                                glm::dot(glm::dvec3(light.edgeY), d)) /
                         cosine;
    if (light.isFramed) {
        if (at.uv[0] != glm::clamp(at.uv[0], 0.0, 1.0)) return glm::dvec3(0.0);
        factor /= cosine * cosine * cosine;
    }
    return light.picture ? factor * glm::dvec3(lookUp(scene, *light.picture, at))
                         : glm::dvec3(factor);
}

} // namespace

Lights::Lights(const Scene& scene, const ShadingConventions& conventions)
    : scene_(scene), conventions_(conventions) {
    if (conventions.samplesEmitters) emitters_ = collectEmitters(scene);
    if (haveManyTriangles(emitters_)) {
        many_.push_back(asOneLight(scene, emitters_));
        if (!(many_.back().powerSums.back() > 0)) many_.clear(); // black textures
        std::erase_if(emitters_, [](const Emitter& e) { return e.kind != EmitterKind::Sphere; });
    }
    for (const Emitter& emitter : emitters_)
        areaSums_.push_back(runningAreas(scene, emitter));
    if (scene.environment) environment_.emplace_back(*scene.environment);
    for (const Light& light : scene.lights) {
        if (light.kind == LightKind::Area) {
            if (conventions.samplesEmitters)
                throw std::invalid_argument("area light '" + light.name +
                                            "' is not resolved to an emitter");
            areas_.push_back(&light);
        } else if (light.kind == LightKind::Ambient) {
            ambient_.push_back(&light);
        } else {
            delta_.push_back(&light);
        }
    }
}

LightSample Lights::sampleBroad(size_t index, const SurfacePoint& surface,
                                RandomStream& random) const {
    random.beginBlock();
    if (index < many_.size()) return sampleMany(surface, random);
    index -= many_.size();
    if (index < emitters_.size()) return sampleEmitter(index, surface, random);
    index -= emitters_.size();
    if (index < ambient_.size()) return sampleAmbient(*ambient_[index], surface, random);
    index -= ambient_.size();
    if (index < environment_.size()) {
        const EnvironmentMap::Sample s =
            environment_[index].sample({random.next(), random.next(), random.next()});
        return {s.direction, s.weight, true, s.direction};
    }
    return sampleRectangle(*areas_[index - environment_.size()], litPoint(surface), conventions_,
                           random);
}

LightSample Lights::sampleMany(const SurfacePoint& surface, RandomStream& random) const {
    const ManyTriangles& many = many_.front();
    const size_t picked = pickByShare(many.powerSums, random.next());
    const EmitterTriangle triangle(scene_, many.triangles[picked]);
    const Material& material = scene_.materials[scene_.triangles[triangle.index].material];
    const double probability = many.powers[picked] / many.powerSums.back();
    return sampleTriangle(triangle, probability, material, surface, random);
}

LightSample Lights::sampleEmitter(size_t index, const SurfacePoint& surface,
                                  RandomStream& random) const {
    const Emitter& emitter = emitters_[index];
    const Material& material = scene_.materials[emitter.material];
    if (emitter.kind == EmitterKind::Sphere) return sampleSphere(scene_, emitter, surface, random);
    const double u = random.next();
    if (emitter.kind == EmitterKind::Quad) { // its triangles by solid angle
        const EmitterTriangle a(scene_, emitter.triangles[0]), b(scene_, emitter.triangles[1]);
        const double ofA = solidAngle(a, litPoint(surface)), ofB = solidAngle(b, litPoint(surface));
        const double share = ofA + ofB > 0 ? ofA / (ofA + ofB) : 0.5;
        return u < share ? sampleTriangle(a, share, material, surface, random)
                         : sampleTriangle(b, 1 - share, material, surface, random);
    }
    const EmitterTriangle triangle(scene_, emitter.triangles[pickByShare(areaSums_[index], u)]);
    return sampleTriangle(triangle, triangle.area / emitter.area, material, surface, random);
}

LightSample Lights::sampleAmbient(const Light& light, const SurfacePoint& surface,
                                  RandomStream& random) const {
    const double u = random.next(), v = random.next();
    const bool upper = light.upperHemisphereOnly || !conventions_.ambientAboutNormal;
    const Frame frame(upper ? glm::dvec3(0, 1, 0) : surface.shading);
    LightSample sample;
    sample.direction = frame.toWorld(uniformHemisphere(u, v));
    sample.value = glm::dvec3(light.color) * (2 * kPi);
    return sample;
}

/// The share of the way to a point light, at its end, where nothing shades: docs/estimator.md.
constexpr double kPointLightGap = 0x1p-16;

LightSample Lights::sampleDelta(size_t index, const SurfacePoint& surface) const {
    const Light& light = *delta_[index];
    const glm::dvec3 axis = glm::normalize(glm::dvec3(light.direction));
    LightSample sample;
    sample.value = light.color;
    if (light.kind == LightKind::Directional) {
        sample.direction = -axis;
        return sample;
    }
    sample.infinite = false;
    const glm::dvec3 to = glm::dvec3(light.position) - litPoint(surface);
    sample.target = glm::dvec3(light.position) - kPointLightGap * to;
    const double distance = glm::length(to);
    if (distance == 0) return LightSample{};
    sample.direction = to / distance;
    sample.value /= attenuation(light, distance);
    if (light.kind == LightKind::Projector)
        sample.value *= projected(scene_, light, axis, -sample.direction);
    if (light.kind == LightKind::Spot)
        sample.value *= spotFalloff(light, -glm::dot(sample.direction, axis));
    return sample;
}

glm::dvec3 Lights::ambientRadiance(const glm::dvec3& direction) const {
    glm::dvec3 sum(0.0);
    if (!conventions_.bouncesFindAllLight) return sum;
    for (const Light* light : ambient_)
        if (!light->upperHemisphereOnly || direction.y > 0) sum += glm::dvec3(light->color);
    for (const EnvironmentMap& environment : environment_)
        sum += environment.radiance(direction);
    return sum;
}

glm::dvec3 Lights::backdrop(const glm::dvec3& direction) const {
    return environment_.empty() ? glm::dvec3(0.0) : environment_.front().radiance(direction);
}

} // namespace stromboli::reference

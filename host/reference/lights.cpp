#include "host/reference/lights.hpp"

#include "host/core/color.hpp"
#include "scene/model/mean_emission.hpp"
#include "scene/model/surface_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace stromboli::reference {

// --- The environment -----------------------------------------------------------------------------

namespace {

/// Counter-clockwise about +y, seen from above.
glm::dvec3 rotate(const glm::dvec3& v, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

struct Picked {
    size_t index;
    double rest; ///< uniform in [0, 1)
};

/// sums: running sums of weights.
Picked pick(const double* sums, size_t count, double u) {
    const double target = u * sums[count - 1];
    const size_t index =
        std::min(size_t(std::upper_bound(sums, sums + count, target) - sums), count - 1);
    const double before = index == 0 ? 0 : sums[index - 1];
    return {index, std::clamp((target - before) / (sums[index] - before), 0.0, 1.0)};
}

} // namespace

EnvironmentMap::EnvironmentMap(const Environment& environment) : environment_(environment) {
    const int64_t width = environment.width, height = environment.height;
    double sum = 0;
    for (int64_t y = 0; y < height; ++y) {
        const double solidAngle = 2 * kPi / double(width) *
                                  (std::cos(environment.rows().polarAt(double(y))) -
                                   std::cos(environment.rows().polarAt(double(y + 1))));
        double inRow = 0;
        for (int64_t x = 0; x < width; ++x)
            sumsInRow_.push_back(inRow += neighbourhoodLuminance(x, y) * solidAngle);
        rowSums_.push_back(sum += inRow);
    }
}

glm::dvec3 EnvironmentMap::texel(int64_t x, int64_t y) const {
    const int64_t width = environment_.width, height = environment_.height;
    const int64_t row = std::clamp<int64_t>(y, 0, height - 1), column = (x + width) % width;
    return environment_.radiance[size_t(row * width + column)];
}

double EnvironmentMap::neighbourhoodLuminance(int64_t x, int64_t y) const {
    double most = 0;
    for (int64_t dy = -1; dy <= 1; ++dy)
        for (int64_t dx = -1; dx <= 1; ++dx)
            most = std::max(most, luminance(texel(x + dx, y + dy)));
    return most;
}

glm::dvec3 EnvironmentMap::radiance(const glm::dvec3& direction) const {
    const glm::dvec3 d = rotate(direction, -double(environment_.rotation));
    const double u = std::atan2(d.x, -d.z) / (2 * kPi) + 0.5;
    const double polar = std::acos(std::clamp(d.y, -1.0, 1.0));
    const double x = u * environment_.width - 0.5;
    const double y = environment_.rows().placeAt(polar) - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto column = int64_t(left), row = int64_t(top);
    const glm::dvec3 above = glm::mix(texel(column, row), texel(column + 1, row), x - left);
    const glm::dvec3 below = glm::mix(texel(column, row + 1), texel(column + 1, row + 1), x - left);
    return double(environment_.strength) * glm::mix(above, below, y - top);
}

EnvironmentMap::Sample EnvironmentMap::sample(const glm::dvec3& u) const {
    const size_t width = environment_.width, height = environment_.height;
    Sample s;
    if (!(rowSums_.back() > 0)) return s;
    const Picked row = pick(rowSums_.data(), height, u.x);
    const double* const sums = sumsInRow_.data() + row.index * width;
    const Picked column = pick(sums, width, u.y);
    // Uniform by solid angle in the texel: in the azimuth and in the height y.
    const double top = std::cos(environment_.rows().polarAt(double(row.index)));
    const double bottom = std::cos(environment_.rows().polarAt(double(row.index + 1)));
    const double y = glm::mix(top, bottom, u.z);
    const double azimuth =
        2 * kPi * ((double(column.index) + column.rest) / double(width) - 0.5); // from -z
    const double sine = std::sqrt(std::max(1 - y * y, 0.0));
    s.direction = rotate({sine * std::sin(azimuth), y, -sine * std::cos(azimuth)},
                         double(environment_.rotation));
    const double before = column.index == 0 ? 0 : sums[column.index - 1];
    const double probability = (sums[column.index] - before) / rowSums_.back();
    const double solidAngle = 2 * kPi / double(width) * (top - bottom);
    s.weight = radiance(s.direction) * (solidAngle / probability);
    return s;
}

// --- All lights ----------------------------------------------------------------------------------

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
    if (surface.medium && !upper) {
        sample.direction = uniformSphere(u, v);
        sample.value = glm::dvec3(light.color) * (4 * kPi);
        return sample;
    }
    sample.direction = frame.toWorld(uniformHemisphere(u, v));
    sample.value = glm::dvec3(light.color) * (2 * kPi);
    return sample;
}

/// The share of the way to a point light, at its end, where nothing shades:
/// docs/theory/estimator.md.
constexpr double kPointLightGap = 0x1p-16;

LightSample Lights::sampleDelta(size_t index, const SurfacePoint& surface,
                                RandomStream& /*random*/) const {
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

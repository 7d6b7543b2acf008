#include "scene/pbrt/environment.hpp"

#include "scene/build/vectors.hpp"
#include "scene/pbrt/colors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stromboli::pbrt {
namespace {

size_t wrapped(double i, uint32_t count) {
    const double n = count;
    return size_t(std::clamp(i - n * std::floor(i / n), 0.0, n - 1));
}

/// The direction of a place in this program's environments (scene/model/environment.hpp).
glm::dvec3 directionOf(double u, double v) {
    const double sine = std::sin(std::numbers::pi * v);
    return {-sine * std::sin(2 * std::numbers::pi * u), std::cos(std::numbers::pi * v),
            sine * std::cos(2 * std::numbers::pi * u)};
}

/// What the upper half of all directions of a map gives a plane, by pbrt-v4's sum, in which a texel
/// counts as half of its solid angle.
double illuminanceOf(const DirectionMap& map) {
    double sum = 0;
    for (uint32_t y = 0; y < map.image.height; ++y)
        for (uint32_t x = 0; x < map.image.width; ++x) {
            const glm::dvec3 w =
                directionOfSquare({(x + 0.5) / map.image.width, (y + 0.5) / map.image.height});
            const glm::dvec3 texel(map.image.texels[size_t(y) * map.image.width + x]);
            sum += std::max(w.z, 0.0) * luminance(texel);
        }
    return sum * 2 * std::numbers::pi / (double(map.image.width) * map.image.height);
}

} // namespace

glm::dvec3 directionOfSquare(const glm::dvec2& place) {
    const glm::dvec2 p = 2.0 * place - 1.0, a = glm::abs(p);
    const double beyond = 1 - (a.x + a.y), r = 1 - std::abs(beyond);
    const double phi = (r == 0 ? 1 : (a.y - a.x) / r + 1) * std::numbers::pi / 4;
    const double across = r * std::sqrt(std::max(2 - r * r, 0.0));
    return {std::copysign(across * std::cos(phi), p.x), std::copysign(across * std::sin(phi), p.y),
            std::copysign(1 - r * r, beyond)};
}

glm::dvec2 squareOfDirection(const glm::dvec3& direction) {
    const glm::dvec3 a = glm::abs(direction);
    const double r = std::sqrt(std::max(1 - a.z, 0.0));
    const double phi = a.x == 0 && a.y == 0 ? 0 : std::atan2(a.y, a.x) * 2 / std::numbers::pi;
    glm::dvec2 p(r - phi * r, phi * r);
    if (direction.z < 0) p = {1 - p.y, 1 - p.x};
    return (glm::dvec2(std::copysign(p.x, direction.x), std::copysign(p.y, direction.y)) + 1.0) /
           2.0;
}

glm::dvec3 DirectionMap::at(const glm::dvec3& direction) const {
    const auto texel = [&](size_t x, size_t y) {
        return glm::dvec3(image.texels[y * image.width + x]);
    };
    if (isSquare) { // the nearest texel, as pbrt-v4 takes it
        const glm::dvec2 at = squareOfDirection(direction) * glm::dvec2(image.width, image.height);
        return texel(std::min(size_t(at.x), size_t(image.width - 1)),
                     std::min(size_t(at.y), size_t(image.height - 1)));
    }
    const double u = std::atan2(direction.y, direction.x) / (2 * std::numbers::pi);
    const double v = std::acos(std::clamp(direction.z, -1.0, 1.0)) / std::numbers::pi;
    const double x = u * image.width - 0.5, y = v * image.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto row = [&](double i) { return size_t(std::clamp(i, 0.0, double(image.height - 1))); };
    const auto along = [&](double i) {
        return glm::mix(texel(wrapped(left, image.width), row(i)),
                        texel(wrapped(left + 1, image.width), row(i)), x - left);
    };
    return glm::mix(along(top), along(top + 1), y - top);
}

DirectionMap readDirectionMap(Context& context, const Parameters& light, const std::string& name) {
    const std::filesystem::path file = context.files.find(light.place(), name);
    DirectionMap map{images::readFloatImage(file), false};
    for (const images::PictureFault& fault : map.image.faults)
        light.replace(fault.kind, fmt::format("{}: {}", file.string(), fault.problem));
    const bool isSquare = map.image.width == map.image.height;
    map.isSquare = !context.isV3() && isSquare;
    if (!context.isV3() && !isSquare)
        light.replace(build::Shortfall::Model,
                      "has a picture that is no square, expected pbrt-v4's map of equal areas",
                      "a map by latitude and longitude");
    return map;
}

/// Four corners of a rectangle, one after the other, in the world.
void Surroundings::addPortal(const Parameters& light) {
    const std::vector<glm::dvec3> p = light.points("portal");
    const auto isCorner = [&](const glm::dvec3& at) { return build::inRange(at); };
    bool isRectangle = p.size() == 4 && std::ranges::all_of(p, isCorner);
    if (isRectangle) {
        const glm::dvec3 a = p[1] - p[0], b = p[3] - p[0];
        const double size = glm::length(a) + glm::length(b);
        isRectangle = glm::length(a) > 0 && glm::length(b) > 0 &&
                      std::abs(glm::dot(glm::normalize(a), glm::normalize(b))) < 1e-3 &&
                      glm::distance(p[2], p[1] + b) < 1e-3 * size;
    }
    if (!isRectangle)
        return light.replace(build::Shortfall::Model,
                             "has a portal that is not the four corners of a rectangle",
                             "light from everywhere");
    context_.builder.addPortal(p[0], p[1] - p[0], p[3] - p[0]);
    context_.report().assume("light 'infinite': its portal says where samples aim, and light comes "
                             "through all other openings as well");
}

void Surroundings::add(const Parameters& light, const glm::dmat4& worldFromLight) {
    const char* name = context_.isV3() || light.has("mapname") ? "mapname" : "filename";
    const std::optional<std::string> file = light.text(name);
    const std::optional<glm::dvec3> stated = colorOf(context_, light, "L", ColorOf::Light);
    glm::dvec3 factor =
        stated.value_or(glm::dvec3(1)) * light.number("scale", 1, 0, 1e30) * context_.imagingRatio;
    if (const std::optional<glm::dvec3> scale =
            context_.isV3() ? colorOf(context_, light, "scale", ColorOf::Number) : std::nullopt)
        factor = stated.value_or(glm::dvec3(1)) * *scale * context_.imagingRatio;
    const double illuminance = light.number("illuminance").value_or(0);
    if (light.has("portal")) addPortal(light);
    light.skip({"samples", "nsamples"});
    if (!file) {
        isThere_ = true;
        if (illuminance > 0) factor *= illuminance / std::numbers::pi;
        constant_ += glm::dvec3(context_.builder.lightColor("L", glm::vec3(factor)));
        return;
    }
    Map map{readDirectionMap(context_, light, *file), glm::inverse(glm::dmat3(worldFromLight)),
            factor, *file};
    if (illuminance > 0 && map.picture.isSquare) {
        const double has = illuminanceOf(map.picture);
        if (has > 0) map.factor *= illuminance / has;
    }
    maps_.push_back(std::move(map));
    isThere_ = true;
}

/// Whether texels can stay what they are: rows become rows, and columns columns.
bool Surroundings::setUpright(const Map& map) {
    if (map.picture.isSquare) return false;
    const glm::dmat3 world = glm::inverse(map.lightFromWorld);
    if (!build::isSimilarity(glm::dmat4(world))) return false;
    const glm::dvec3 x = glm::normalize(world[0]), y = glm::normalize(world[1]),
                     z = glm::normalize(world[2]);
    constexpr double kChance = 1e-6;
    const bool isGrey = map.factor.x == map.factor.y && map.factor.y == map.factor.z;
    if (std::abs(z.y) < 1 - kChance || !isGrey) return false;
    const auto share = [](const glm::dvec3& d) {
        return std::atan2(-d.x, d.z) / (2 * std::numbers::pi);
    };
    const double first = share(x), quarter = share(y) - first;
    const bool isMirrored = quarter - std::floor(quarter) > 0.5;
    const images::FloatImage& image = map.picture.image;
    Environment environment;
    environment.name = map.name;
    environment.width = image.width;
    environment.height = image.height;
    environment.strength = float(map.factor.x);
    environment.rotation = float(-2 * std::numbers::pi * first);
    environment.radiance.clear();
    environment.radiance.reserve(image.texels.size());
    for (uint32_t row = 0; row < image.height; ++row)
        for (uint32_t column = 0; column < image.width; ++column) {
            const size_t from = size_t(z.y > 0 ? row : image.height - 1 - row) * image.width;
            environment.radiance.push_back(
                image.texels[from + (isMirrored ? image.width - 1 - column : column)]);
        }
    context_.builder.setEnvironment(std::move(environment));
    return true;
}

/// Means of the sum of all over each texel of a new picture.
void Surroundings::resample() {
    constexpr uint32_t kMostRows = 4096, kSteps = 3;
    uint32_t rows = 2;
    for (const Map& map : maps_) {
        const images::FloatImage& image = map.picture.image;
        rows = std::max(rows, map.picture.isSquare ? image.height : 2 * image.height);
    }
    rows = std::min(rows, kMostRows);
    Environment environment;
    environment.name = maps_.front().name;
    environment.width = 2 * rows;
    environment.height = rows;
    environment.radiance.clear();
    environment.radiance.reserve(size_t(2) * rows * rows);
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < 2 * rows; ++column) {
            glm::dvec3 sum(0.0);
            for (uint32_t i = 0; i < kSteps * kSteps; ++i) {
                const double u = (column + (i % kSteps + 0.5) / kSteps) / (2.0 * rows);
                const double v = (row + (i / kSteps + 0.5) / kSteps) / rows;
                for (const Map& map : maps_)
                    sum += map.factor *
                           map.picture.at(glm::normalize(map.lightFromWorld * directionOf(u, v)));
            }
            environment.radiance.emplace_back(sum / double(kSteps * kSteps) + constant_);
        }
    context_.builder.setEnvironment(std::move(environment));
}

void Surroundings::finish() {
    if (!isThere_) return;
    if (maps_.empty()) {
        Environment environment;
        environment.name = "infinite";
        environment.radiance = {glm::vec3(constant_)};
        return context_.builder.setEnvironment(std::move(environment));
    }
    if (maps_.size() > 1 || constant_ != glm::dvec3(0) || !setUpright(maps_.front())) resample();
}

} // namespace stromboli::pbrt

// Surfaces that are turned about the z axis, as polyhedra whose corners lie on them.

#include "scene/build/surface_mesh.hpp"
#include "scene/build/vectors.hpp"
#include "scene/pbrt/forms.hpp"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace stromboli::pbrt {
namespace {

constexpr uint32_t kSides = build::kSphereSides; ///< around

/// A line of points, v in [0, 1], that is turned.
using Profile = std::function<glm::dvec3(double v)>;

glm::dvec3 turned(const glm::dvec3& p, double phi) {
    const double c = std::cos(phi), s = std::sin(phi);
    return {p.x * c - p.y * s, p.x * s + p.y * c, p.z};
}

/// Normals are those of u, around the axis, times v. rows: 1 where the profile is straight.
Form turnedForm(const Profile& profile, double phiMax, uint32_t rows) {
    const bool isWhole = phiMax >= 2 * std::numbers::pi;
    const auto columns =
        uint32_t(std::max(std::ceil(kSides * std::min(phiMax / (2 * std::numbers::pi), 1.0)), 1.0));
    Form form;
    form.hasCoordinates = true;
    form.mesh = build::gridMesh(columns, rows, [&](double u, double v) {
        build::SurfacePoint point;
        // Exactly where it begins, if it is closed.
        const double phi = isWhole && u >= 1 ? 0 : u * phiMax;
        point.position = turned(profile(v), phi);
        // At poles the derivative around the axis has no length: beside them it has.
        constexpr double kStep = 1e-6;
        const double inside = std::clamp(v, 2 * kStep, 1 - 2 * kStep);
        const glm::dvec3 p = profile(inside);
        const glm::dvec3 along = profile(inside + kStep) - profile(inside - kStep);
        point.normal = turned(
            build::unit(glm::cross(glm::dvec3(-p.y, p.x, 0), along)).value_or(glm::dvec3(0, 0, 1)),
            phi);
        point.uv = {u, v};
        return point;
    });
    return form;
}

double positive(const Parameters& shape, const char* name, double otherwise) {
    const double value = shape.number(name).value_or(otherwise);
    if (value != 0) return std::abs(value);
    shape.place().fail(std::string("has a '") + name + "' of 0, expected more");
}

Form sphere(const Parameters& shape, double phiMax) {
    const double r = positive(shape, "radius", 1);
    double low = shape.number("zmin").value_or(-r), high = shape.number("zmax").value_or(r);
    if (low > high) std::swap(low, high);
    low = std::clamp(low, -r, r);
    high = std::clamp(high, -r, r);
    const double from = std::acos(low / r), to = std::acos(high / r);
    const Profile profile = [=](double v) {
        const double theta = std::lerp(from, to, v);
        const bool isPole = theta <= 0 || theta >= std::numbers::pi;
        return glm::dvec3(isPole ? 0 : r * std::sin(theta), 0, r * std::cos(theta));
    };
    const bool isWhole = phiMax >= 2 * std::numbers::pi && low <= -r && high >= r;
    if (!isWhole) return turnedForm(profile, phiMax, kSides / 2);
    Form form;
    form.hasCoordinates = true;
    form.sphereRadius = r;
    form.makeMesh = [=] { return turnedForm(profile, phiMax, kSides / 2).mesh; };
    return form;
}

Form cylinder(const Parameters& shape, double phiMax) {
    const double r = positive(shape, "radius", 1);
    double low = shape.number("zmin").value_or(-1), high = shape.number("zmax").value_or(1);
    if (low > high) std::swap(low, high);
    return turnedForm([=](double v) { return glm::dvec3(r, 0, std::lerp(low, high, v)); }, phiMax,
                      1);
}

Form disk(const Parameters& shape, double phiMax) {
    const double r = positive(shape, "radius", 1), inner = shape.number("innerradius").value_or(0);
    const double height = shape.number("height").value_or(0);
    Form form = turnedForm([=](double v) { return glm::dvec3(std::lerp(r, inner, v), 0, height); },
                           phiMax, 1);
    build::makeFlat(form.mesh);
    return form;
}

Form cone(const Parameters& shape, double phiMax) {
    const double r = positive(shape, "radius", 1), height = positive(shape, "height", 1);
    return turnedForm([=](double v) { return glm::dvec3(r * (1 - v), 0, height * v); }, phiMax, 1);
}

Form paraboloid(const Parameters& shape, double phiMax) {
    const double r = positive(shape, "radius", 1);
    double low = shape.number("zmin").value_or(0), high = shape.number("zmax").value_or(1);
    if (low > high) std::swap(low, high);
    if (!(high > 0)) shape.place().fail("has a 'zmax' of 0 or less");
    low = std::max(low, 0.0);
    return turnedForm(
        [=](double v) {
            const double z = std::lerp(low, high, v);
            return glm::dvec3(r * std::sqrt(z / high), 0, z);
        },
        phiMax, kSides / 4);
}

Form hyperboloid(const Parameters& shape, double phiMax) {
    const glm::dvec3 from = shape.vector("p1").value_or(glm::dvec3(0)),
                     to = shape.vector("p2").value_or(glm::dvec3(1));
    return turnedForm([=](double v) { return glm::mix(from, to, v); }, phiMax, kSides / 4);
}

} // namespace

std::optional<Form> revolvedForm(const std::string& kind, const Parameters& shape) {
    struct Kind {
        std::string_view name;
        Form (*make)(const Parameters&, double phiMax);
    };
    static constexpr Kind kKinds[] = {
        {"sphere", sphere}, {"cylinder", cylinder},     {"disk", disk},
        {"cone", cone},     {"paraboloid", paraboloid}, {"hyperboloid", hyperboloid}};
    const auto* found = std::ranges::find(kKinds, kind, &Kind::name);
    if (found == std::end(kKinds)) return std::nullopt;
    const double degrees = shape.number("phimax", 360, 0, 360);
    if (!(degrees > 0)) shape.place().fail("has a 'phimax' of 0, expected more");
    return found->make(shape, glm::radians(degrees));
}

} // namespace stromboli::pbrt

// Curves as tubes, and NURBS patches as grids.

#include "scene/build/surface_mesh.hpp"
#include "scene/build/tubes.hpp"
#include "scene/build/vectors.hpp"
#include "scene/pbrt/forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace stromboli::pbrt {
namespace {

/// Lines that stand for a segment of a curve: so many that they are off by `most` or less.
int stepsOf(std::span<const glm::dvec3> controls, double most) {
    constexpr int kMostSteps = 16;
    const glm::dvec3 first = controls.front(), chord = controls.back() - first;
    const double squared = glm::dot(chord, chord);
    double away = 0;
    for (const glm::dvec3& p : controls) {
        const double along =
            squared > 0 ? std::clamp(glm::dot(p - first, chord) / squared, 0.0, 1.0) : 0;
        away = std::max(away, glm::length(p - first - along * chord));
    }
    const double steps = std::ceil(std::sqrt(away / std::max(most, 1e-30)));
    return int(std::clamp(std::isnan(steps) ? 1.0 : steps, 1.0, double(kMostSteps)));
}

/// The values that control a Bezier curve, at t: de Casteljau.
glm::dvec3 bezier(std::vector<glm::dvec3> points, double t) {
    for (size_t left = points.size(); left > 1; --left)
        for (size_t i = 0; i + 1 < left; ++i)
            points[i] = glm::mix(points[i], points[i + 1], t);
    return points.front();
}

/// The uniform B-spline of degree 2 or 3 that so many points control, at t in [0, 1].
glm::dvec3 bSpline(std::span<const glm::dvec3> p, double t) {
    const double u = 1 - t;
    if (p.size() == 3) return 0.5 * u * u * p[0] + (0.5 + t * u) * p[1] + 0.5 * t * t * p[2];
    return (u * u * u * p[0] + (3 * t * t * t - 6 * t * t + 4) * p[1] +
            (3 * u * u * u - 6 * u * u + 4) * p[2] + t * t * t * p[3]) /
           6.0;
}

/// Homogeneous points of one direction of a patch, and its knots.
struct NurbsAxis {
    int64_t count = 0, order = 0;
    std::vector<double> knots;
    double from = 0, to = 1;

    /// The weights of all points at t, by the recursion of Cox and de Boor.
    std::vector<double> weights(double t) const {
        const auto last = size_t(count + order) - 1;
        std::vector<double> n(last, 0.0);
        size_t at = size_t(order) - 1;
        while (at + 1 < size_t(count) && t >= knots[at + 1])
            ++at;
        n[at] = 1;
        for (size_t degree = 1; degree < size_t(order); ++degree)
            for (size_t i = 0; i + degree < last; ++i) {
                const double left = knots[i + degree] - knots[i];
                const double right = knots[i + degree + 1] - knots[i + 1];
                n[i] = (left > 0 ? (t - knots[i]) / left * n[i] : 0) +
                       (right > 0 ? (knots[i + degree + 1] - t) / right * n[i + 1] : 0);
            }
        n.resize(size_t(count));
        return n;
    }
};

NurbsAxis axisOf(const Parameters& shape, const std::string& letter) {
    NurbsAxis axis;
    axis.count = shape.integer("n" + letter).value_or(-1);
    axis.order = shape.integer(letter + "order").value_or(-1);
    axis.knots = shape.numbers(letter + "knots");
    if (axis.order < 2 || axis.order > 32 || axis.count < axis.order || axis.count > 100'000 ||
        axis.knots.size() != size_t(axis.count + axis.order) || !std::ranges::is_sorted(axis.knots))
        shape.place().fail(fmt::format("has {} knots in {} for {} points of order {}, expected as "
                                       "many as both together, ascending",
                                       axis.knots.size(), letter, axis.count, axis.order));
    const double first = axis.knots[size_t(axis.order) - 1], last = axis.knots[size_t(axis.count)];
    axis.from = std::clamp(shape.number(letter + "0").value_or(first), first, last);
    axis.to = std::clamp(shape.number(letter + "1").value_or(last), first, last);
    return axis;
}

} // namespace

Form curveForm(const Context& context, const Parameters& shape) {
    const std::vector<glm::dvec3> points = shape.points("P");
    const int64_t degree = std::clamp<int64_t>(shape.integer("degree").value_or(3), 2, 3);
    const bool isBSpline = shape.text("basis").value_or("bezier") == "bspline";
    const double width = shape.number("width", 1, 0, 1e30);
    const double from = shape.number("width0", width, 0, 1e30),
                 to = shape.number("width1", width, 0, 1e30);
    if (shape.text("type").value_or("flat") == "ribbon")
        shape.replace(build::Shortfall::Model, "is a ribbon", "a tube as wide");
    shape.skip({"N", "splitdepth"});
    const auto order = size_t(degree + 1), step = isBSpline ? size_t(1) : size_t(degree);
    if (points.size() < order || (!isBSpline && (points.size() - order) % step != 0))
        shape.place().fail(
            fmt::format("has {} points, which make no curve of degree {}", points.size(), degree));
    const size_t segments = (points.size() - order) / step + 1;
    build::Strand strand;
    for (size_t segment = 0; segment < segments; ++segment) {
        const std::span controls = std::span(points).subspan(segment * step, order);
        const int steps = stepsOf(controls, context.tubes.tolerance * std::max(from, to));
        for (int i = segment == 0 ? 0 : 1; i <= steps; ++i) {
            const double t = double(i) / steps;
            const glm::dvec3 at =
                isBSpline ? bSpline(controls, t) : bezier({controls.begin(), controls.end()}, t);
            if (!strand.empty() && strand.back().place == at) continue;
            const double along = (double(segment) + t) / double(segments);
            strand.push_back({at, std::lerp(from, to, along) / 2});
        }
    }
    if (strand.size() < 2) shape.place().fail("is a point");
    Form form;
    form.hasCoordinates = true;
    form.mesh.parts.emplace_back();
    build::addTube(form.mesh, strand, context.tubes.sides);
    return form;
}

Form nurbsForm(const Parameters& shape) {
    const NurbsAxis u = axisOf(shape, "u"), v = axisOf(shape, "v");
    const bool isWeighed = !shape.has("P");
    const std::vector<double> numbers = shape.numbers(isWeighed ? "Pw" : "P");
    const size_t each = isWeighed ? 4 : 3;
    if (numbers.size() != each * size_t(u.count) * size_t(v.count))
        shape.place().fail(
            fmt::format("has {} numbers for {} times {} points", numbers.size(), u.count, v.count));
    const auto point = [&](double s, double t) {
        const std::vector<double> a = u.weights(s), b = v.weights(t);
        glm::dvec4 sum(0.0);
        for (size_t j = 0; j < b.size(); ++j)
            for (size_t i = 0; i < a.size(); ++i) {
                if (a[i] * b[j] == 0) continue;
                const double* p = &numbers[each * (j * a.size() + i)];
                sum += a[i] * b[j] * glm::dvec4(p[0], p[1], p[2], isWeighed ? p[3] : 1);
            }
        return glm::dvec3(sum) / sum.w;
    };
    constexpr uint32_t kDice = 30; // as pbrt does
    Form form;
    form.hasCoordinates = true;
    form.mesh = build::gridMesh(kDice, kDice, [&](double s, double t) {
        const double a = std::lerp(u.from, u.to, s), b = std::lerp(v.from, v.to, t);
        const double da = (u.to - u.from) * 1e-5, db = (v.to - v.from) * 1e-5;
        const auto slope = [&](double ds, double dt) {
            const auto inside = [](const NurbsAxis& axis, double x) {
                return std::clamp(x, axis.from, axis.to);
            };
            return point(inside(u, a + ds), inside(v, b + dt)) -
                   point(inside(u, a - ds), inside(v, b - dt));
        };
        build::SurfacePoint result;
        result.position = point(a, b);
        result.normal = glm::cross(slope(da, 0), slope(0, db));
        result.uv = {a, b};
        return result;
    });
    return form;
}

} // namespace stromboli::pbrt

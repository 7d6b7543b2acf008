#include "scene/mitsuba/hair.hpp"

#include "scene/build/read_file.hpp"
#include "scene/build/tubes.hpp"
#include "scene/build/vectors.hpp"
#include "scene/mitsuba/words.hpp"

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

namespace stromboli::mitsuba {
namespace {

using build::Knot;
using build::Strand;

/// After a head and the number of knots, three floats each; before the first one of a strand there
/// is an infinite one.
std::vector<Strand> binaryStrands(std::string_view bytes, double radius) {
    std::vector<Strand> strands(1);
    const auto next = [&](float& value) {
        if (bytes.size() < sizeof value) return false;
        std::memcpy(&value, bytes.data(), sizeof value);
        bytes.remove_prefix(sizeof value);
        return true;
    };
    float x = 0, y = 0, z = 0;
    while (next(x)) {
        if (std::isinf(x)) {
            strands.emplace_back();
            continue;
        }
        if (!next(y) || !next(z)) break;
        if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z))
            strands.back().push_back({{x, y, z}, radius});
    }
    return strands;
}

/// A knot in each line, with or without a radius; an empty line ends a strand.
std::vector<Strand> textStrands(const build::FilePlace& where, std::string_view text,
                                double radius) {
    std::vector<Strand> strands(1);
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        const std::vector<double> numbers = numbersOf(where, text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (numbers.empty()) {
            strands.emplace_back();
        } else if (numbers.size() < 3) {
            where.fail(
                fmt::format("has a line of {} numbers, expected three or four", numbers.size()));
        } else {
            strands.back().push_back({{numbers[0], numbers[1], numbers[2]},
                                      numbers.size() > 3 ? std::max(numbers[3], 0.0) : radius});
        }
    }
    return strands;
}

/// Without the knots at which a strand hardly bends.
Strand straightened(const Strand& strand, double degrees) {
    const double most = std::cos(glm::radians(degrees));
    Strand kept;
    for (size_t i = 0; i < strand.size(); ++i) {
        if (!kept.empty() && strand[i].place == kept.back().place) continue;
        if (kept.size() > 1) {
            const auto before = build::unit(kept.back().place - kept[kept.size() - 2].place);
            const auto after = build::unit(strand[i].place - kept.back().place);
            if (before && after && glm::dot(*before, *after) > most) kept.pop_back();
        }
        kept.push_back(strand[i]);
    }
    return kept;
}

/// Lines that stand for a segment of a uniform cubic B-spline: by its second derivative, which is
/// largest at an end.
int stepsOf(const Strand& knots, size_t i, double tolerance) {
    constexpr int kMostSteps = 6;
    double bend = 0, width = 0;
    for (size_t k = i; k < i + 2; ++k) {
        const glm::dvec3 second = knots[k].place - 2.0 * knots[k + 1].place + knots[k + 2].place;
        const double swelling =
            std::abs(knots[k].radius - 2 * knots[k + 1].radius + knots[k + 2].radius);
        bend = std::max({bend, glm::length(second), swelling});
        width = std::max(width, 2 * knots[k + 1].radius);
    }
    const double steps = std::ceil(std::sqrt(bend / (8 * std::max(tolerance * width, 1e-30))));
    return int(std::clamp(std::isnan(steps) ? 1.0 : steps, 1.0, double(kMostSteps)));
}

/// Points of the uniform cubic B-spline that the knots control.
Strand splined(const Strand& knots, double tolerance) {
    Strand points;
    for (size_t i = 0; i + 3 < knots.size(); ++i) {
        const int steps = stepsOf(knots, i, tolerance);
        for (int step = i == 0 ? 0 : 1; step <= steps; ++step) {
            const double t = double(step) / steps, u = 1 - t;
            const double weights[4] = {u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                                       (3 * u * u * u - 6 * u * u + 4) / 6, t * t * t / 6};
            Knot& point = points.emplace_back();
            for (size_t k = 0; k < 4; ++k) {
                point.place += weights[k] * knots[i + k].place;
                point.radius += weights[k] * knots[i + k].radius;
            }
        }
    }
    return points;
}

} // namespace

bool isHair(const Plugin& shape) {
    return shape.type == "hair" || shape.type == "linearcurve" || shape.type == "bsplinecurve";
}

build::Mesh hairMesh(const Context& context, const Plugin& shape) {
    const std::filesystem::path file = context.document.file(shape, "filename");
    const std::string bytes = build::readFile(file);
    const build::FilePlace where{file.string(), 0, "hair"};
    const double radius = shape.number("radius", 0).value_or(0.025);
    const double angle = shape.number("angle_threshold", 0, 90).value_or(1);
    constexpr std::string_view kHead = "BINARY_HAIR";
    const size_t head = kHead.size() + sizeof(uint32_t);
    const bool isBinary = bytes.starts_with(kHead) && bytes.size() >= head;
    const std::vector<Strand> strands =
        isBinary ? binaryStrands(std::string_view(bytes).substr(head), radius)
                 : textStrands(where, bytes, radius);
    size_t points = 0;
    for (const Strand& strand : strands)
        points += strand.size();
    const build::TubeDetail detail = build::tubeDetail(points);
    if (points > build::kMostDetailedPoints)
        context.report().assume("hair of so many strands has tubes of three sides");
    build::requireMemory(where.file, bytes.size() * 20 * detail.sides);
    build::Mesh mesh;
    mesh.parts.emplace_back();
    for (const Strand& strand : strands) {
        const Strand line = shape.type == "bsplinecurve" ? splined(strand, detail.tolerance)
                            : shape.type == "hair"       ? straightened(strand, angle)
                                                         : straightened(strand, 0);
        if (line.size() > 1) build::addTube(mesh, line, detail.sides);
    }
    if (mesh.positions.empty()) where.fail("has no strand of two points or more");
    return mesh;
}

} // namespace stromboli::mitsuba

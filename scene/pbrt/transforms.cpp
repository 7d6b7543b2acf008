#include "scene/pbrt/transforms.hpp"

#include "scene/build/vectors.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace stromboli::pbrt {

void TransformStack::set(const glm::dmat4& start, const glm::dmat4& end) {
    if (current.changesStart) current.start = start;
    if (current.changesEnd) current.end = end;
}

void TransformStack::multiply(const glm::dmat4& by) {
    set(current.start * by, current.end * by);
}

void TransformStack::name(const std::string& system, const Transforms& transforms) {
    systems_[system] = transforms;
}

bool TransformStack::apply(const Statement& s) {
    const std::string& directive = s.directive();
    const std::vector<double>& n = s.numbers;
    const glm::dmat4 one(1.0);
    const auto vector = [&](size_t i) { return glm::dvec3(n[i], n[i + 1], n[i + 2]); };
    // Numbers are listed by columns.
    const auto matrix = [&] {
        glm::dmat4 m;
        for (int i = 0; i < 16; ++i)
            m[i / 4][i % 4] = n[size_t(i)];
        return m;
    };
    if (directive == "Identity") {
        set(one, one);
    } else if (directive == "Translate") {
        multiply(glm::translate(one, vector(0)));
    } else if (directive == "Scale") {
        if (n[0] == 0 || n[1] == 0 || n[2] == 0) s.place.fail("has the factor 0, expected others");
        multiply(glm::scale(one, vector(0)));
    } else if (directive == "Rotate") {
        const std::optional<glm::dvec3> axis = build::unit(vector(1));
        if (!axis) s.place.fail("has no axis: its last three numbers are 0");
        multiply(glm::rotate(one, glm::radians(n[0]), *axis));
    } else if (directive == "LookAt") {
        multiply(glm::inverse(lookAt(s.place, vector(0), vector(3), vector(6))));
    } else if (directive == "Transform") {
        set(matrix(), matrix());
    } else if (directive == "ConcatTransform") {
        multiply(matrix());
    } else if (directive == "CoordinateSystem") {
        name(s.words.front(), current);
    } else if (directive == "CoordSysTransform") {
        const auto found = systems_.find(s.words.front());
        if (found == systems_.end())
            s.place.fail(fmt::format("names the coordinate system '{}', which is not there",
                                     s.words.front()));
        set(found->second.start, found->second.end);
    } else if (directive == "ActiveTransform") {
        const std::string& which = s.words.front();
        if (which != "All" && which != "StartTime" && which != "EndTime")
            s.place.fail(fmt::format("has '{}', expected All, StartTime or EndTime", which));
        current.changesStart = which != "EndTime";
        current.changesEnd = which != "StartTime";
    } else {
        return false;
    }
    return true;
}

glm::dmat4 lookAt(const build::FilePlace& where, const glm::dvec3& eye, const glm::dvec3& at,
                  const glm::dvec3& up) {
    const std::optional<glm::dvec3> z = build::unit(at - eye);
    if (!z) where.fail("looks at the place where it is");
    std::optional<glm::dvec3> x = build::unit(glm::cross(up, *z));
    if (!x) where.fail("looks along its up direction");
    return {glm::dvec4(*x, 0), glm::dvec4(glm::cross(*z, *x), 0), glm::dvec4(*z, 0),
            glm::dvec4(eye, 1)};
}

std::optional<glm::dmat4> aimed(const glm::dvec3& from, const glm::dvec3& to) {
    const std::optional<glm::dvec3> z = build::unit(to - from);
    if (!z) return std::nullopt;
    // pbrt takes the larger of x and y to find an axis across; spots are round, so that it does not
    // matter which one.
    const glm::dvec3 other = std::abs(z->x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(other, *z));
    return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(*z, x), 0), glm::dvec4(*z, 0),
                      glm::dvec4(from, 1));
}

} // namespace stromboli::pbrt

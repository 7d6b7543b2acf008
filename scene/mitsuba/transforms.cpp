#include "scene/mitsuba/transforms.hpp"

#include "scene/build/vectors.hpp"
#include "scene/mitsuba/words.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>

#include <vector>

namespace stromboli::mitsuba {
namespace {

/// By one attribute, or by three whose names begin with the same letter, as before Mitsuba 0.3.
std::optional<glm::dvec3> vectorNamed(const build::FilePlace& where, const Attributes& attributes,
                                      std::string_view name) {
    if (const std::optional<std::string> text = attributes(name)) return vectorOf(where, *text);
    glm::dvec3 v(0.0);
    bool isThere = false;
    for (const int axis : {0, 1, 2})
        if (const std::optional<std::string> text = attributes(std::string{name[0], "xyz"[axis]})) {
            v[axis] = numberOf(where, *text);
            isThere = true;
        }
    return isThere ? std::optional(v) : std::nullopt;
}

glm::dvec3 requireVector(const build::FilePlace& where, const Attributes& attributes,
                         const char* name) {
    const std::optional<glm::dvec3> v = vectorNamed(where, attributes, name);
    if (!v) where.fail(fmt::format("has no attribute '{}'", name));
    return *v;
}

/// The frame of a camera or lamp at `origin` that looks along its z axis at `target`, y up and x to
/// the left.
glm::dmat4 lookAt(const build::FilePlace& where, const Attributes& attributes) {
    const glm::dvec3 origin = requireVector(where, attributes, "origin");
    const glm::dvec3 target = requireVector(where, attributes, "target");
    const std::optional<glm::dvec3> ahead = build::unit(target - origin);
    if (!ahead) where.fail("looks from a point at itself");
    // Without `up` any direction across the view is as good.
    const glm::dvec3 across = std::abs(ahead->x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 up = vectorNamed(where, attributes, "up").value_or(across);
    const std::optional<glm::dvec3> left = build::unit(glm::cross(up, *ahead));
    if (!left) where.fail("looks along 'up', expected a direction across it");
    // Cameras of those times had x to the right.
    const double side = attributes("ox") ? -1 : 1;
    return {glm::dvec4(side * *left, 0), glm::dvec4(glm::cross(*ahead, *left), 0),
            glm::dvec4(*ahead, 0), glm::dvec4(origin, 1)};
}

glm::dmat4 rotation(const build::FilePlace& where, const Attributes& attributes) {
    const std::optional<glm::dvec3> axis = build::unit(vectorOfAttributes(where, attributes, 0));
    if (!axis) where.fail("rotates about an axis of no length: expected x, y or z");
    const std::optional<std::string> angle = attributes("angle");
    if (!angle) where.fail("has no attribute 'angle'");
    return glm::rotate(glm::dmat4(1), glm::radians(numberOf(where, *angle)), *axis);
}

/// Rows of four numbers or of three, for which the rest is that of the identity.
glm::dmat4 matrix(const build::FilePlace& where, const Attributes& attributes) {
    const std::optional<std::string> text = attributes("value");
    if (!text) where.fail("has no attribute 'value'");
    const std::vector<double> v = numbersOf(where, *text);
    if (v.size() != 16 && v.size() != 9)
        where.fail(fmt::format("has {} numbers, expected 16 or 9", v.size()));
    const int side = v.size() == 16 ? 4 : 3;
    glm::dmat4 m(1.0);
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            m[column][row] = v[size_t(row * side + column)];
    return m;
}

} // namespace

glm::dvec3 vectorOfAttributes(const build::FilePlace& where, const Attributes& attributes,
                              double otherwise) {
    if (const std::optional<std::string> value = attributes("value"))
        return vectorOf(where, *value);
    glm::dvec3 v(otherwise);
    for (const int axis : {0, 1, 2})
        if (const std::optional<std::string> text =
                attributes(std::string_view("xyz").substr(size_t(axis), 1)))
            v[axis] = numberOf(where, *text);
    return v;
}

glm::dmat4 transformStep(const build::FilePlace& where, std::string_view tag,
                         const Attributes& attributes) {
    const glm::dmat4 identity(1.0);
    if (tag == "translate")
        return glm::translate(identity, vectorOfAttributes(where, attributes, 0));
    if (tag == "scale") return glm::scale(identity, vectorOfAttributes(where, attributes, 1));
    if (tag == "rotate") return rotation(where, attributes);
    if (tag == "lookat") return lookAt(where, attributes);
    if (tag == "matrix") return matrix(where, attributes);
    where.fail("is no step of a transform, expected translate, rotate, scale, lookat or matrix");
}

} // namespace stromboli::mitsuba

#include "scene/collada/transforms.hpp"

#include "scene/collada/numbers.hpp"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace stromboli::collada {
namespace {

glm::dvec3 vectorAt(const std::vector<double>& numbers, size_t first) {
    return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

glm::dvec3 direction(const Document& document, const Element& at, const glm::dvec3& v,
                     const char* what) {
    const double length = glm::length(v);
    if (!(length > 0) || !std::isfinite(length))
        document.fail(at, fmt::format("the {} must be a vector of non-zero length", what));
    return v / length;
}

glm::dmat4 readMatrix(const Document& document, const Element& at) {
    const std::vector<double> rows = readNumbers(document, at, 16);
    if (rows[12] != 0 || rows[13] != 0 || rows[14] != 0 || rows[15] != 1)
        document.fail(at, "the last four numbers must be 0 0 0 1 (matrices are written row by "
                          "row; the translation is the last column)");
    return matrixOfRows(rows);
}

glm::dmat4 readTranslate(const Document& document, const Element& at) {
    return glm::translate(glm::dmat4(1), vectorAt(readNumbers(document, at, 3), 0));
}

glm::dmat4 readScale(const Document& document, const Element& at) {
    return glm::scale(glm::dmat4(1), vectorAt(readNumbers(document, at, 3), 0));
}

glm::dmat4 readRotate(const Document& document, const Element& at) {
    const std::vector<double> numbers = readNumbers(document, at, 4);
    if (numbers[3] == 0) return glm::dmat4(1); // exporters write 0 0 0 0 for no rotation
    const glm::dvec3 axis = direction(document, at, vectorAt(numbers, 0), "axis of rotation");
    return glm::rotate(glm::dmat4(1), glm::radians(numbers[3]), axis);
}

/// Places the node at the eye, its -z axis towards the point of interest.
glm::dmat4 readLookat(const Document& document, const Element& at) {
    const std::vector<double> numbers = readNumbers(document, at, 9);
    const glm::dvec3 eye = vectorAt(numbers, 0), interest = vectorAt(numbers, 3);
    const glm::dvec3 back = direction(document, at, eye - interest, "line of sight");
    const glm::dvec3 up = direction(document, at, vectorAt(numbers, 6), "up axis");
    const glm::dvec3 right =
        direction(document, at, glm::cross(up, back), "up axis across the line of sight");
    return {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
            glm::dvec4(eye, 1)};
}

/// RenderMan's Skew, which COLLADA cites: a shear along the second axis b that turns the first
/// axis a by the angle towards b. Points along b stay where they are.
glm::dmat4 readSkew(const Document& document, const Element& at) {
    const std::vector<double> numbers = readNumbers(document, at, 7);
    const glm::dvec3 a = direction(document, at, vectorAt(numbers, 1), "axis of rotation");
    const glm::dvec3 b = direction(document, at, vectorAt(numbers, 4), "axis of translation");
    const double along = glm::dot(a, b);
    const glm::dvec3 across = a - along * b;
    const double distance = glm::length(across);
    const double between = std::atan2(distance, along) - glm::radians(numbers[0]);
    if (!(distance > 0) || !(between > 0) || !(between < glm::radians(180.0)))
        document.fail(at, "the angle must keep the axis of rotation off the axis of translation");
    const double shift = distance * std::cos(between) / std::sin(between) - along;
    const glm::dvec3 height = across / (distance * distance); // dot(height, a) = 1
    glm::dmat4 matrix(1);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            matrix[column][row] += shift * b[row] * height[column];
    return matrix;
}

glm::dmat4 readTransform(const Document& document, const Element& at) {
    if (named(at, "matrix")) return readMatrix(document, at);
    if (named(at, "translate")) return readTranslate(document, at);
    if (named(at, "rotate")) return readRotate(document, at);
    if (named(at, "scale")) return readScale(document, at);
    if (named(at, "lookat")) return readLookat(document, at);
    return readSkew(document, at);
}

std::string_view trimmedText(const Element& at) {
    const char* text = at.GetText();
    std::string_view trimmed = text ? text : "";
    const char* spaces = " \t\r\n";
    trimmed.remove_prefix(std::min(trimmed.find_first_not_of(spaces), trimmed.size()));
    return trimmed.substr(0, trimmed.find_last_not_of(spaces) + 1);
}

glm::dmat4 axesToWorld(const Document& document) {
    const Element* asset = document.root().FirstChildElement("asset");
    const Element* upAxis = asset ? asset->FirstChildElement("up_axis") : nullptr;
    const std::string_view name = upAxis ? trimmedText(*upAxis) : "Y_UP";
    const auto matrix = [](const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z) {
        return glm::dmat4(glm::dmat3(x, y, z));
    };
    if (name == "Y_UP") return glm::dmat4(1);
    if (name == "Z_UP") return matrix({-1, 0, 0}, {0, 0, 1}, {0, 1, 0});
    if (name == "X_UP") return matrix({0, 1, 0}, {1, 0, 0}, {0, 0, -1});
    document.replace(*upAxis, build::Shortfall::Word,
                     fmt::format("'{}' is not X_UP, Y_UP or Z_UP", name));
    return glm::dmat4(1);
}

} // namespace

glm::dmat4 matrixOfRows(const std::vector<double>& numbers) {
    glm::dmat4 matrix;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            matrix[column][row] = numbers[size_t(row * 4 + column)];
    return matrix;
}

double metersPerUnit(const Document& document) {
    const Element* asset = document.root().FirstChildElement("asset");
    const Element* unit = asset ? asset->FirstChildElement("unit") : nullptr;
    if (!unit) return 1;
    try {
        const double meter = readAttributeOr(document, *unit, "meter", 1);
        if (!(meter > 0)) document.fail(*unit, "the attribute 'meter' must be greater than 0");
        return meter;
    } catch (const SceneError& error) {
        document.replace(error, build::Shortfall::Parameter);
        return 1;
    }
}

glm::dmat4 fileToWorld(const Document& document, bool useUnit) {
    const double scale = useUnit ? metersPerUnit(document) : 1;
    return glm::scale(glm::dmat4(1), glm::dvec3(scale)) * axesToWorld(document);
}

bool isTransform(const Element& element) {
    for (const char* name : {"matrix", "translate", "rotate", "scale", "lookat", "skew"})
        if (named(element, name)) return true;
    return false;
}

glm::dmat4 nodeTransform(const Document& document, const Element& node) {
    glm::dmat4 product(1);
    for (const Element& child : children(node)) {
        if (!isTransform(child)) continue;
        try {
            product *= readTransform(document, child);
        } catch (const SceneError& error) {
            document.replace(error, build::Shortfall::Parameter);
        }
    }
    return product;
}

} // namespace stromboli::collada

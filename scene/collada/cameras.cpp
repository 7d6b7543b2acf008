#include "scene/collada/cameras.hpp"

#include "scene/collada/numbers.hpp"
#include "scene/collada/transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace stromboli::collada {
namespace {

std::optional<double> readPositive(const Document& document, const Element& parent,
                                   const char* name, double below) {
    const Element* at = parent.FirstChildElement(name);
    if (!at) return std::nullopt;
    const double value = readNumber(document, *at);
    if (!(value > 0 && value < below))
        document.fail(*at, std::isinf(below)
                               ? fmt::format("is {}, expected more than 0", value)
                               : fmt::format("is {}, expected between 0 and {}", value, below));
    return value;
}

constexpr double kNoLimit = HUGE_VAL;

void readPerspective(const Document& document, const Element& at, FileCamera& camera) {
    camera.x = readPositive(document, at, "xfov", 180);
    camera.y = readPositive(document, at, "yfov", 180);
    if (!camera.x && !camera.y) document.fail(at, "has neither <xfov> nor <yfov>");
    for (std::optional<double>* angle : {&camera.x, &camera.y})
        if (*angle) *angle = glm::radians(**angle);
}

void readOrthographic(const Document& document, const Element& at, FileCamera& camera) {
    camera.orthographic = true;
    camera.x = readPositive(document, at, "xmag", kNoLimit);
    camera.y = readPositive(document, at, "ymag", kNoLimit);
    if (!camera.x && !camera.y) document.fail(at, "has neither <xmag> nor <ymag>");
}

void readDepthRange(Context& context, const Element& at, FileCamera& camera) {
    const Document& document = context.document;
    camera.nearDistance = readNumberOr(document, at, "znear", camera.nearDistance);
    camera.farDistance = readNumberOr(document, at, "zfar", camera.farDistance);
    if (camera.nearDistance < 0) {
        context.report.warn(fmt::format("camera '{}': negative <znear> taken as 0", camera.name));
        camera.nearDistance = 0;
    }
    if (!(camera.farDistance > camera.nearDistance))
        document.fail(at, fmt::format("<zfar> ({}) must be greater than <znear> ({})",
                                      camera.farDistance, camera.nearDistance));
}

/// Applies the lengths of the node's axes (the document's unit among them) to the camera's own.
/// False if one of them is no length.
bool scaleToWorld(Context& context, FileCamera& camera) {
    glm::dvec3 scale;
    for (int axis = 0; axis < 3; ++axis)
        scale[axis] = glm::length(glm::dvec3(camera.toWorld[axis]));
    const double smallest = std::min({scale.x, scale.y, scale.z});
    const double largest = std::max({scale.x, scale.y, scale.z});
    if (!(smallest > 0) || !std::isfinite(largest)) return false;
    // Files carry about six digits: what is less apart was meant to be equal.
    if (largest / smallest > 1.0001)
        context.report.warn(fmt::format("camera '{}': its node scales the axes unequally, which "
                                        "its picture does not show",
                                        camera.name));
    if (context.options.cs184) return true;
    if (camera.orthographic) {
        if (camera.x) *camera.x *= scale.x;
        if (camera.y) *camera.y *= scale.y;
    }
    camera.nearDistance *= scale.z;
    camera.farDistance *= scale.z;
    return true;
}

} // namespace

void placeCamera(Context& context, const Element& element, const glm::dmat4& toWorld) {
    const Document& document = context.document;
    const Element& technique =
        document.require(document.require(element, "optics"), "technique_common");
    const Element* perspective = technique.FirstChildElement("perspective");
    const Element* orthographic = technique.FirstChildElement("orthographic");
    if (!perspective && !orthographic)
        document.fail(technique, "has neither <perspective> nor <orthographic>");
    const Element& at = perspective ? *perspective : *orthographic;

    FileCamera camera;
    camera.name = displayName(element);
    camera.toWorld = toWorld;
    if (perspective)
        readPerspective(document, at, camera);
    else
        readOrthographic(document, at, camera);
    camera.aspectRatio = readPositive(document, at, "aspect_ratio", kNoLimit);
    readDepthRange(context, at, camera);
    if (scaleToWorld(context, camera)) {
        context.scene.cameras.push_back(camera);
    } else {
        context.report.warn(fmt::format(
            "camera '{}' is left out: its node's transformation is singular", camera.name));
    }
}

} // namespace stromboli::collada

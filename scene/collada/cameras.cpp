#include "scene/collada/cameras.hpp"

#include "scene/collada/numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

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

/// COLLADA states the width of a view, its height, both, or one of them with the ratio of the two;
/// the ratio beside both says nothing new.
void setExtents(const Document& document, const Element& at, std::optional<double> halfWidth,
                std::optional<double> halfHeight, FileCamera& camera) {
    if (const auto aspect = readPositive(document, at, "aspect_ratio", kNoLimit)) {
        if (!halfHeight)
            halfHeight = *halfWidth / *aspect;
        else if (!halfWidth)
            halfWidth = *halfHeight * *aspect;
    }
    camera.halfWidth = halfWidth;
    camera.halfHeight = halfHeight;
}

void readPerspective(const Document& document, const Element& at, FileCamera& camera) {
    const auto halfTangent = [&](const char* name) -> std::optional<double> {
        const std::optional<double> degrees = readPositive(document, at, name, 180);
        if (!degrees) return std::nullopt;
        return std::tan(glm::radians(*degrees) / 2);
    };
    const std::optional<double> x = halfTangent("xfov"), y = halfTangent("yfov");
    if (!x && !y) document.fail(at, "has neither <xfov> nor <yfov>");
    setExtents(document, at, x, y, camera);
}

void readOrthographic(const Document& document, const Element& at, FileCamera& camera) {
    camera.projection = Projection::Orthographic;
    const std::optional<double> x = readPositive(document, at, "xmag", kNoLimit);
    const std::optional<double> y = readPositive(document, at, "ymag", kNoLimit);
    if (!x && !y) document.fail(at, "has neither <xmag> nor <ymag>");
    setExtents(document, at, x, y, camera);
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
    if (perspective)
        readPerspective(document, at, camera);
    else
        readOrthographic(document, at, camera);
    readDepthRange(context, at, camera);
    context.builder.placeCamera(std::move(camera), toWorld);
}

} // namespace stromboli::collada

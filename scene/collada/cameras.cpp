#include "scene/collada/cameras.hpp"

#include "scene/collada/numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace stromboli::collada {
namespace {

/// A number that makes no sense counts as not stated.
std::optional<double> readPositive(const Document& document, const Element& parent,
                                   const char* name, double below) {
    const Element* at = parent.FirstChildElement(name);
    if (!at) return std::nullopt;
    try {
        const double value = readNumber(document, *at);
        if (value > 0 && value < below) return value;
        document.replace(*at, build::Shortfall::Parameter,
                         std::isinf(below)
                             ? fmt::format("is {}, expected more than 0", value)
                             : fmt::format("is {}, expected between 0 and {}", value, below));
    } catch (const SceneError& error) {
        document.replace(error, build::Shortfall::Parameter);
    }
    return std::nullopt;
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
    if (!(camera.farDistance > camera.nearDistance)) {
        document.replace(at, build::Shortfall::Parameter,
                         fmt::format("<zfar> ({}) must be greater than <znear> ({})",
                                     camera.farDistance, camera.nearDistance));
        camera.nearDistance = FileCamera().nearDistance;
        camera.farDistance = FileCamera().farDistance;
    }
}

/// The element that says what the camera sees; null where nothing does.
const Element* projectionOf(const Document& document, const Element& camera) {
    const Element* optics = camera.FirstChildElement("optics");
    const Element* technique = optics ? optics->FirstChildElement("technique_common") : nullptr;
    if (technique)
        for (const char* known : {"perspective", "orthographic"})
            if (const Element* projection = technique->FirstChildElement(known)) return projection;
    document.forgive(camera,
                     fmt::format("'{}' has no <optics> with a <technique_common> of <perspective> "
                                 "or <orthographic>",
                                 displayName(camera)),
                     kNoCamera);
    return nullptr;
}

} // namespace

void placeCamera(Context& context, const Element& element, const glm::dmat4& toWorld) {
    const Element* projection = projectionOf(context.document, element);
    if (!projection) return;
    FileCamera camera;
    camera.name = displayName(element);
    if (named(*projection, "perspective"))
        readPerspective(context.document, *projection, camera);
    else
        readOrthographic(context.document, *projection, camera);
    readDepthRange(context, *projection, camera);
    context.builder.placeCamera(std::move(camera), toWorld);
}

} // namespace stromboli::collada

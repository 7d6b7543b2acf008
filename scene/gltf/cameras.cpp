#include "scene/gltf/cameras.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace stromboli::gltf {
namespace {

double positive(const Element& at, std::string_view member) {
    const double value = at.number(member);
    if (!(value > 0)) at.fail(member, fmt::format("is {}, expected more than 0", value));
    return value;
}

void readDepths(const Element& at, FileCamera& camera) {
    camera.nearDistance = at.number("znear", 0, 0, std::numeric_limits<double>::infinity());
    camera.farDistance = at.number("zfar", camera.farDistance);
    if (camera.farDistance > camera.nearDistance) return;
    at.forgive(build::Shortfall::Word, "zfar",
               fmt::format("is {}, expected more than znear, {}", camera.farDistance,
                           camera.nearDistance));
    camera.farDistance = FileCamera().farDistance;
}

} // namespace

void placeCamera(Context& context, const Element& at, const std::string& name,
                 const glm::dmat4& toWorld) {
    FileCamera camera;
    camera.name = name;
    const std::string type = at.text("type");
    const std::optional<Element> lens = at.child(type);
    if (type != "perspective" && type != "orthographic")
        at.fail("type", fmt::format("is '{}', expected perspective or orthographic", type));
    if (!lens) at.fail(fmt::format("has no '{}'", type));
    if (type == "perspective") {
        const double angle = positive(*lens, "yfov");
        if (!(angle < std::numbers::pi))
            lens->fail("yfov", fmt::format("is {}, expected less than pi", angle));
        camera.halfHeight = std::tan(angle / 2);
        const double aspect = lens->number("aspectRatio", NAN);
        if (aspect > 0)
            camera.halfWidth = *camera.halfHeight * aspect;
        else if (!std::isnan(aspect)) // which is none that a file can state
            lens->forgive(build::Shortfall::Word, "aspectRatio",
                          fmt::format("is {}, expected more than 0", aspect));
    } else {
        camera.projection = Projection::Orthographic;
        camera.halfWidth = std::abs(lens->number("xmag"));
        camera.halfHeight = std::abs(lens->number("ymag"));
        if (!(*camera.halfWidth > 0 && *camera.halfHeight > 0))
            lens->fail("has a view without width or height");
    }
    readDepths(*lens, camera);
    context.builder.placeCamera(std::move(camera), toWorld);
}

} // namespace stromboli::gltf

#include "scene/mitsuba/sensors.hpp"

#include "scene/build/vectors.hpp"
#include "scene/mitsuba/words.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace stromboli::mitsuba {
namespace {

struct Film {
    uint32_t width = 768, height = 576;
    std::optional<std::array<uint32_t, 4>> crop;
    HintedFilter filter = HintedFilter::Gaussian;
    HintedFilterShape shape;

    double aspect() const { return double(width) / height; }
};

uint32_t sideOf(const Plugin& film, const char* name, uint32_t otherwise) {
    constexpr int64_t kMost = 65536;
    const int64_t side = film.integer(name).value_or(otherwise);
    if (side < 1 || side > kMost)
        film.replaceParameter(name, build::Shortfall::Number,
                              fmt::format("is {}, expected 1 to {}", side, kMost));
    return uint32_t(std::clamp<int64_t>(side, 1, kMost));
}

/// The window of the film that is rendered; none where it is all of it.
std::optional<std::array<uint32_t, 4>> cropOf(const Plugin& film, uint32_t width, uint32_t height) {
    const auto stated = [&](const char* name, uint32_t otherwise, uint32_t least, uint32_t most) {
        const int64_t value = film.integer(name).value_or(otherwise);
        if (value < least || value > most)
            film.replaceParameter(name, build::Shortfall::Number,
                                  fmt::format("is {}, expected {} to {}", value, least, most));
        return uint32_t(std::clamp<int64_t>(value, least, most));
    };
    const uint32_t x = stated("crop_offset_x", 0, 0, width - 1);
    const uint32_t y = stated("crop_offset_y", 0, 0, height - 1);
    const uint32_t w = stated("crop_width", width - x, 1, width - x);
    const uint32_t h = stated("crop_height", height - y, 1, height - y);
    if (w == width && h == height) return std::nullopt;
    return std::array{x, y, w, h};
}

double positive(const Plugin& filter, const char* name, double otherwise) {
    const double value = filter.number(name, 0).value_or(otherwise);
    if (value > 0) return value;
    filter.replaceParameter(name, build::Shortfall::Word, "is 0, expected more");
    return otherwise;
}

uint32_t lobesOf(const Plugin& filter) {
    constexpr int64_t kMost = 64; // each as wide as a pixel
    const int64_t lobes = filter.integer("lobes").value_or(3);
    if (lobes < 1 || lobes > kMost)
        filter.replaceParameter("lobes", build::Shortfall::Number,
                                fmt::format("is {}, expected 1 to {}", lobes, kMost));
    return uint32_t(std::clamp<int64_t>(lobes, 1, kMost));
}

void readFilter(const Plugin& film, Film& read) {
    const Plugin* filter = film.onlyChildOf("rfilter");
    if (!filter) return;
    const std::string& type = filter->type;
    if (type == "box") {
        read.filter = HintedFilter::Box;
    } else if (type == "tent") {
        read.filter = HintedFilter::Tent;
        read.shape.radius = positive(*filter, "radius", 1);
    } else if (type == "gaussian") {
        read.shape.deviation = positive(*filter, "stddev", 0.5);
    } else if (type == "mitchell") {
        read.filter = HintedFilter::Mitchell;
        // Names of old files are in small letters by now.
        read.shape.b = filter->number(filter->isOld ? "b" : "B").value_or(1.0 / 3);
        read.shape.c = filter->number(filter->isOld ? "c" : "C").value_or(1.0 / 3);
    } else if (type == "catmullrom") {
        read.filter = HintedFilter::CatmullRom;
    } else if (type == "lanczos") {
        read.filter = HintedFilter::Lanczos;
        read.shape.lobes = lobesOf(*filter);
    } else {
        filter->replace(build::Shortfall::Model,
                        fmt::format("'{}' is no filter that is read, expected box, tent, gaussian, "
                                    "mitchell, catmullrom or lanczos",
                                    type),
                        "gaussian");
    }
    filter->requireAllRead();
}

Film filmOf(Context& context, const Plugin& sensor) {
    Film film;
    const Plugin* plugin = sensor.onlyChildOf("film");
    if (!plugin) return film;
    if (plugin->type != "hdrfilm" && plugin->type != "specfilm")
        plugin->replace(build::Shortfall::Model,
                        fmt::format("'{}' is no film that is read, expected hdrfilm", plugin->type),
                        "hdrfilm");
    film.width = sideOf(*plugin, "width", film.width);
    film.height = sideOf(*plugin, "height", film.height);
    readFilter(*plugin, film);
    film.crop = cropOf(*plugin, film.width, film.height);
    for (const char* unused :
         {"pixel_format", "component_format", "file_format", "filename", "banner",
          "high_quality_edges", "sample_border", "gamma", "attach_log", "compensate", "alpha"})
        plugin->skip(unused);
    ignoreUnread(context, *plugin);
    return film;
}

/// "50mm" or a number: the focal length for a picture of 36 x 24 mm.
double focalLengthOf(const Plugin& sensor) {
    constexpr double kUsual = 50;
    const Value* value = sensor.find("focal_length");
    double length = kUsual;
    if (value && std::holds_alternative<std::string>(*value)) {
        std::string text = *sensor.text("focal_length");
        if (text.ends_with("mm")) text.resize(text.size() - 2);
        length = numberOf(sensor.place, text);
    } else if (value) {
        length = sensor.number("focal_length").value_or(kUsual);
    }
    if (length > 0) return length;
    sensor.replaceParameter("focal_length", build::Shortfall::Word,
                            fmt::format("is {}, expected more", length));
    return kUsual;
}

void readLens(const Plugin& sensor, FileCamera& camera) {
    camera.lensRadius = sensor.number("aperture_radius", 0).value_or(0);
    camera.focusDistance = sensor.number("focus_distance", 0).value_or(1);
    if (camera.focusDistance > 0) return;
    sensor.replaceParameter("focus_distance", build::Shortfall::Word, "is 0, expected more");
    camera.focusDistance = 1;
}

/// Shares of the picture's width and height, by which its middle moves to the right and down.
void readPrincipalPoint(const Plugin& sensor, FileCamera& camera) {
    camera.shift.x = 2 * sensor.number("principal_point_offset_x").value_or(0) * *camera.halfWidth;
    camera.shift.y =
        -2 * sensor.number("principal_point_offset_y").value_or(0) * *camera.halfHeight;
}

void readPerspective(const Plugin& sensor, double aspect, FileCamera& camera) {
    camera.halfWidth = halfWidthOf(sensor, aspect);
    camera.halfHeight = *camera.halfWidth / aspect;
    if (sensor.type == "thinlens")
        readLens(sensor, camera);
    else
        readPrincipalPoint(sensor, camera);
    sensor.skip("focus_distance");
    sensor.skip("fov_axis");
}

/// Mitsuba's camera looks along z, x to the left; a scale is the size of an orthographic view.
glm::dmat4 poseOf(const Plugin& sensor) {
    glm::dmat4 m = sensor.transform("to_world");
    // A camera of Mitsuba 0.3 had x to the right.
    if (sensor.isAncient) m = m * glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1));
    return m * glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, -1));
}

/// That of Mitsuba 0.3 is the smaller side's unless it says otherwise.
std::string fovAxisOf(const Plugin& sensor) {
    if (!sensor.isAncient) return sensor.text("fov_axis").value_or("x");
    const bool isSmaller = sensor.flag("map_smaller_side").value_or(true);
    return sensor.text("fov_axis").value_or(isSmaller ? "smaller" : "larger");
}

/// What of its kind there is: every camera but an orthographic one is shown in perspective.
void replaceUnknown(const Plugin& sensor) {
    sensor.replace(build::Shortfall::Model,
                   fmt::format("'{}' is no sensor that is read, expected perspective, thinlens or "
                               "orthographic",
                               sensor.type),
                   sensor.type == "telecentric" ? "orthographic" : "perspective");
    for (const char* unused : {"aperture_radius", "kc", "focus_distance"})
        sensor.skip(unused);
}

} // namespace

double halfWidthOf(const Plugin& sensor, double aspect) {
    const double perDiagonal = aspect / std::sqrt(1 + aspect * aspect);
    if (!sensor.has("fov")) return std::hypot(36.0, 24.0) / 2 / focalLengthOf(sensor) * perDiagonal;
    if (sensor.has("focal_length"))
        sensor.replaceParameter("focal_length", build::Shortfall::Parameter,
                                "is stated beside fov, expected one of both");
    constexpr double kUsual = 45;
    double degrees = sensor.number("fov").value_or(kUsual);
    if (!(degrees > 0 && degrees < 180)) {
        sensor.replaceParameter(
            "fov", build::Shortfall::Word,
            fmt::format("is {}, expected more than 0 and less than 180", degrees));
        degrees = kUsual;
    }
    const double tangent = std::tan(glm::radians(degrees) / 2);
    const bool isWide = aspect > 1;
    const std::string axis = fovAxisOf(sensor);
    if (axis == "diagonal") return tangent * perDiagonal;
    if (axis == "y" || axis == (isWide ? "smaller" : "larger")) return tangent * aspect;
    if (axis != "x" && axis != "larger" && axis != "smaller")
        sensor.replaceParameter(
            "fov_axis", build::Shortfall::Word,
            fmt::format("is '{}', expected x, y, diagonal, smaller or larger", axis));
    return tangent;
}

/// Where it is empty, all is shown.
static void loseDepthRange(const Plugin& sensor, FileCamera& camera) {
    sensor.replaceParameter("far_clip", build::Shortfall::Parameter, "is not more than near_clip");
    camera.nearDistance = FileCamera().nearDistance;
    camera.farDistance = FileCamera().farDistance;
}

void placeSensor(Context& context, Media& media, const Plugin& sensor, bool isFirst) {
    const Film film = filmOf(context, sensor);
    FileCamera camera;
    camera.name = sensor.displayName();
    const bool isKnown =
        sensor.type == "perspective" || sensor.type == "thinlens" || sensor.type == "orthographic";
    if (!isKnown) replaceUnknown(sensor);
    if (sensor.type == "orthographic" || sensor.type == "telecentric") {
        camera.projection = Projection::Orthographic;
        camera.halfWidth = 1;
        camera.halfHeight = 1 / film.aspect();
    } else {
        readPerspective(sensor, film.aspect(), camera);
    }
    camera.nearDistance = sensor.number("near_clip", 0).value_or(camera.nearDistance);
    camera.farDistance = sensor.number("far_clip", 0).value_or(camera.farDistance);
    if (!(camera.farDistance > camera.nearDistance)) loseDepthRange(sensor, camera);
    sensor.childrenOf("sampler");
    for (const char* unused : {"shutter_open", "shutter_close", "srf"})
        sensor.skip(unused);
    const Sides around = sidesOf(sensor);
    camera.medium = media.of(around.inside ? around.inside : around.outside);
    const glm::dmat4 pose = context.worldFromFile * poseOf(sensor);
    sensor.requireAllRead();
    const bool isMirrored = glm::determinant(glm::dmat3(pose)) < 0;
    context.builder.placeCamera(std::move(camera), pose, isMirrored);
    if (!isFirst) return;
    RenderHints& hints = context.builder.hints();
    hints.width = film.width;
    hints.height = film.height;
    hints.crop = film.crop;
    hints.filter = film.filter;
    hints.filterShape = film.shape;
}

} // namespace stromboli::mitsuba

#include "scene/mitsuba/sensors.hpp"

#include "scene/build/vectors.hpp"
#include "scene/mitsuba/words.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

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
    const int64_t side = film.integer(name).value_or(otherwise);
    if (side < 1 || side > 65536) film.fail(name, fmt::format("is {}, expected 1 to 65536", side));
    return uint32_t(side);
}

/// The window of the film that is rendered; none where it is all of it.
std::optional<std::array<uint32_t, 4>> cropOf(const Plugin& film, uint32_t width, uint32_t height) {
    const auto stated = [&](const char* name, uint32_t otherwise, uint32_t least, uint32_t most) {
        const int64_t value = film.integer(name).value_or(otherwise);
        if (value < least || value > most)
            film.fail(name, fmt::format("is {}, expected {} to {}", value, least, most));
        return uint32_t(value);
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
    if (!(value > 0)) filter.fail(name, "is 0, expected more");
    return value;
}

uint32_t lobesOf(const Plugin& filter) {
    constexpr int64_t kMost = 64; // each as wide as a pixel
    const int64_t lobes = filter.integer("lobes").value_or(3);
    if (lobes < 1 || lobes > kMost)
        filter.fail("lobes", fmt::format("is {}, expected 1 to {}", lobes, kMost));
    return uint32_t(lobes);
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
        read.shape.b = filter->number("B").value_or(1.0 / 3);
        read.shape.c = filter->number("C").value_or(1.0 / 3);
    } else if (type == "catmullrom") {
        read.filter = HintedFilter::CatmullRom;
    } else if (type == "lanczos") {
        read.filter = HintedFilter::Lanczos;
        read.shape.lobes = lobesOf(*filter);
    } else {
        filter->fail(fmt::format("'{}' is no filter that is read, expected box, tent, gaussian, "
                                 "mitchell, catmullrom or lanczos",
                                 type));
    }
    filter->requireAllRead();
}

Film filmOf(Context& context, const Plugin& sensor) {
    Film film;
    const Plugin* plugin = sensor.onlyChildOf("film");
    if (!plugin) return film;
    if (plugin->type != "hdrfilm" && plugin->type != "specfilm")
        plugin->fail(fmt::format("'{}' is no film that is read, expected hdrfilm", plugin->type));
    film.width = sideOf(*plugin, "width", film.width);
    film.height = sideOf(*plugin, "height", film.height);
    readFilter(*plugin, film);
    film.crop = cropOf(*plugin, film.width, film.height);
    for (const char* unused :
         {"pixel_format", "component_format", "file_format", "filename", "banner",
          "high_quality_edges", "sample_border", "gamma", "attach_log", "compensate"})
        plugin->skip(unused);
    ignoreUnread(context, *plugin);
    return film;
}

/// "50mm" or a number: the focal length for a picture of 36 x 24 mm.
double focalLengthOf(const Plugin& sensor) {
    std::string text = sensor.text("focal_length").value_or("50mm");
    if (text.ends_with("mm")) text.resize(text.size() - 2);
    const double length = numberOf(sensor.place, text);
    if (!(length > 0)) sensor.fail("focal_length", fmt::format("is {}, expected more", length));
    return length;
}

void readLens(const Plugin& sensor, FileCamera& camera) {
    camera.lensRadius = sensor.number("aperture_radius", 0).value_or(0);
    camera.focusDistance = sensor.number("focus_distance", 0).value_or(1);
    if (!(camera.focusDistance > 0)) sensor.fail("focus_distance", "is 0, expected more");
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
    const glm::dmat4 m = sensor.transform("to_world");
    return m * glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, -1));
}

} // namespace

double halfWidthOf(const Plugin& sensor, double aspect) {
    const double perDiagonal = aspect / std::sqrt(1 + aspect * aspect);
    if (!sensor.has("fov")) return std::hypot(36.0, 24.0) / 2 / focalLengthOf(sensor) * perDiagonal;
    if (sensor.has("focal_length"))
        sensor.fail("focal_length", "is stated beside fov, expected one of both");
    const double degrees = *sensor.number("fov", 0);
    if (!(degrees > 0 && degrees < 180))
        sensor.fail("fov", fmt::format("is {}, expected more than 0 and less than 180", degrees));
    const double tangent = std::tan(glm::radians(degrees) / 2);
    const std::string axis = sensor.text("fov_axis").value_or("x");
    if (axis == "diagonal") return tangent * perDiagonal;
    const bool isWide = aspect > 1;
    if (axis == "x" || axis == (isWide ? "larger" : "smaller")) return tangent;
    if (axis == "y" || axis == (isWide ? "smaller" : "larger")) return tangent * aspect;
    sensor.fail("fov_axis",
                fmt::format("is '{}', expected x, y, diagonal, smaller or larger", axis));
}

void placeSensor(Context& context, const Plugin& sensor, bool isFirst) {
    const Film film = filmOf(context, sensor);
    FileCamera camera;
    camera.name = sensor.displayName();
    if (sensor.type == "perspective" || sensor.type == "thinlens") {
        readPerspective(sensor, film.aspect(), camera);
    } else if (sensor.type == "orthographic") {
        camera.projection = Projection::Orthographic;
        camera.halfWidth = 1;
        camera.halfHeight = 1 / film.aspect();
    } else {
        sensor.fail(fmt::format("'{}' is no sensor that is read, expected perspective, thinlens "
                                "or orthographic",
                                sensor.type));
    }
    camera.nearDistance = sensor.number("near_clip", 0).value_or(camera.nearDistance);
    camera.farDistance = sensor.number("far_clip", 0).value_or(camera.farDistance);
    if (!(camera.farDistance > camera.nearDistance))
        sensor.fail("far_clip", "is not more than near_clip");
    sensor.childrenOf("sampler");
    for (const char* unused : {"shutter_open", "shutter_close", "srf"})
        sensor.skip(unused);
    if (const Plugin* medium = sensor.child("medium"))
        medium->fail("is a medium, which is not supported");
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

#include "scene/add_environment.hpp"

#include "host/core/error.hpp"
#include "scene/build/report.hpp"
#include "scene/find_scene.hpp"
#include "scene/images/float_image.hpp"
#include "scene/sky/sun_sky.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stromboli {
namespace {

Environment fromFile(const EnvironmentRequest& request, LoadReport& lines) {
    const std::string file = environmentFile(request.file);
    uint32_t largest = images::kLargestSide;
    if (request.largestSide > 0) largest = std::min(largest, request.largestSide);
    images::FloatImage image = images::readFloatImage(file, largest);
    build::Report report(request.strict);
    for (const images::PictureFault& fault : image.faults)
        report.replace({file, 0, ""}, fault.kind, fault.problem);
    if (image.isEightBit)
        report.assume("the environment has 8 bits a channel: its light is that of sRGB colours, at "
                      "most 1 (a .hdr or .exr file has a sun that shines)");
    report.writeTo(lines);
    Environment environment;
    environment.name = file;
    environment.width = image.width;
    environment.height = image.height;
    environment.radiance = std::move(image.texels);
    return environment;
}

} // namespace

float rotationOf(const EnvironmentRequest& request, float ofFile) {
    const double degrees = request.rotationDegrees - (request.sun ? request.sun->azimuth : 0.0);
    return float(double(ofFile) + degrees * glm::pi<double>() / 180);
}

Environment environmentOf(const SunRequest& request) {
    sky::SunSky s;
    const double elevation = glm::radians(std::clamp(request.elevation, 0.0, 90.0));
    s.turbidity = request.turbidity;
    s.halfAperture = glm::radians(0.5358 / 2);
    s.sunScale = s.skyScale = 1 / kDaylight;
    s.skyFromWorld = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0));
    s.sun = s.skyFromWorld * glm::dvec3(0, std::sin(elevation), -std::cos(elevation));
    s.sun.z = std::max(s.sun.z, 0.0); // of an elevation of 0, whose sine is rounded
    Environment environment = sky::sunSkyPicture(s, sky::sunIrradiance(s));
    sky::addGround(environment, s.albedo);
    environment.name = fmt::format("sun at {:g},{:g}", request.azimuth, request.elevation);
    return environment;
}

void addEnvironment(Scene& scene, const EnvironmentRequest& request) {
    if (request.sun && (request.constant || !request.file.empty()))
        throw UsageError(
            "a sun and an environment are both the light from all around: expected one "
            "of them");
    Environment environment;
    if (request.sun)
        environment = environmentOf(*request.sun);
    else if (request.constant)
        environment.radiance = {*request.constant};
    else
        environment = fromFile(request, scene.report);
    environment.strength = float(request.strength);
    environment.rotation = rotationOf(request);
    addEnvironment(scene, std::move(environment));
}

void addEnvironment(Scene& scene, Environment environment) {
    scene.environment = std::move(environment);
    const size_t ambient = std::erase_if(
        scene.lights, [](const Light& light) { return light.kind == LightKind::Ambient; });
    if (ambient > 0)
        scene.report.assumed.push_back(
            fmt::format("the environment takes the place of {} ambient light{}", ambient,
                        ambient == 1 ? "" : "s"));
}

} // namespace stromboli

#include "scene/add_environment.hpp"

#include "scene/find_scene.hpp"
#include "scene/images/float_image.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <utility>

namespace stromboli {
namespace {

Environment fromFile(const std::string& name) {
    const std::string file = environmentFile(name);
    images::FloatImage image = images::readFloatImage(file);
    Environment environment;
    environment.name = file;
    environment.width = image.width;
    environment.height = image.height;
    environment.radiance = std::move(image.texels);
    return environment;
}

} // namespace

void addEnvironment(Scene& scene, const EnvironmentRequest& request) {
    Environment environment;
    if (request.constant)
        environment.radiance = {*request.constant};
    else
        environment = fromFile(request.file);
    environment.strength = float(request.strength);
    environment.rotation = float(request.rotationDegrees * glm::pi<double>() / 180);
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

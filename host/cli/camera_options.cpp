// Options: the view and the lens, where the file's camera is not what is wanted.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/core/number_text.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <array>
#include <string_view>
#include <utility>

namespace stromboli {
namespace {

/// The scene's coordinates are below 2^60 metres (docs/numerics.md).
constexpr Range<double> kCoordinates{-1e18, 1e18};
/// A picture plane at distance 1 that is within a thousandth of a degree of half a turn has lost
/// all of its precision.
constexpr Range<double> kAngles{1e-6, 179.999};

glm::dvec3 readPoint(const std::string& option, const Words& words) {
    return {readReal(option + ": x", words[0], kCoordinates),
            readReal(option + ": y", words[1], kCoordinates),
            readReal(option + ": z", words[2], kCoordinates)};
}

/// A positive length; metres, where it has no unit.
double readLength(const std::string& option, const std::string& word) {
    constexpr std::array<std::pair<std::string_view, double>, 5> kUnits = {
        {{"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"m", 1}, {"", 1}}};
    for (const auto& [unit, metres] : kUnits) {
        if (!word.ends_with(unit)) continue;
        const std::optional<double> value = realNumber(word.substr(0, word.size() - unit.size()));
        if (value && *value * metres > 0 && *value * metres <= kCoordinates.most)
            return *value * metres;
        break;
    }
    refuse(option, word,
           "a length greater than 0, in metres or with its unit: 5mm, 2.5cm, 3m, 1km");
}

} // namespace

void declareOptics(DeclaredCommand& c) {
    CameraRequest& camera = c.options.camera;
    c.list
        .words("--look-from", "X Y Z", "look from this point instead of with a camera of the file",
               3, [&camera](const Words& words) { camera.from = readPoint("--look-from", words); })
        .from(inWords(kCoordinates))
        .excludes("--camera", "both say where from");
    c.list
        .words("--look-at", "X Y Z", "what --look-from looks at", 3,
               [&camera](const Words& words) { camera.at = readPoint("--look-at", words); })
        .from(inWords(kCoordinates))
        .needs("--look-from")
        .usually("the scene's middle");
    c.list
        .words("--fov", "DEGREES", "angle of view over the height of the picture", 1,
               [&camera](const Words& words) {
                   camera.fieldOfView =
                       readReal("--fov", words[0], kAngles) * glm::pi<double>() / 180;
               })
        .from(inWords(kAngles))
        .usually("the camera's; --look-from: 40");
    c.list
        .words(
            "--aperture", "LENGTH", "diameter of a thin lens (5mm): blurs what is out of focus", 1,
            [&camera](const Words& words) { camera.aperture = readLength("--aperture", words[0]); })
        .needs("--focus")
        .usually("a pinhole");
    c.list
        .words("--focus", "LENGTH",
               "distance from the camera, along its axis, of what is sharp (2.5m)", 1,
               [&camera](const Words& words) { camera.focus = readLength("--focus", words[0]); })
        .needs("--aperture");
}

} // namespace stromboli

// Options: the view and the lens, where the file's camera is not what is wanted.
#include "host/cli/declared_command.hpp"
#include "host/cli/sequence.hpp"
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

void declareSequence(DeclaredCommand& c) {
    SequenceOptions& sequence = c.options.sequence;
    c.list
        .number(
            "--turntable", "N",
            "N pictures, from cameras all around the scene: each is turned by a further N-th of "
            "a turn, counter-clockwise seen from above, about the vertical axis through its middle",
            sequence.turntable, {1, kFrameNumbers.most})
        .usually("one picture");
    c.list
        .words(
            "--frames", "A..B",
            "a picture of each of these frames: of the file's first animation (glTF), or of "
            "--turntable; OUT.0007.png, or as a pattern says: -o out%04d.png",
            1,
            [&sequence](const Words& words) { sequence.frames = readFrames("--frames", words[0]); })
        .usually("all of --turntable");
    c.list
        .real("--fps", "F", "frames of an animation in a second", sequence.framesPerSecond,
              {1e-3, 1e6})
        .needs("--frames");
}

/// Each picture has files of its own.
void checkSequence(const DeclaredCommand& c) {
    const Options& o = c.options;
    const SequenceOptions& sequence = o.sequence;
    if (!sequence.isGiven()) return;
    const char* option = sequence.turntable > 0 ? "--turntable" : "--frames";
    if (sequence.turntable > 0 && sequence.frames && sequence.frames->last >= sequence.turntable)
        throw UsageError(
            fmt::format("--frames: the turntable has the frames 0 to {}", sequence.turntable - 1));
    if (!o.cameras.empty())
        throw UsageError(fmt::format("{} is of one camera: --camera names several", option));
    if (o.share) throw UsageError(fmt::format("--share is of one picture, and not of {}", option));
    if (o.sampleAlone)
        throw UsageError(fmt::format("--pixel is of one picture, and not of {}", option));
    if (o.output == "-" || o.statsFile == "-")
        throw UsageError(
            fmt::format("- has place for one picture, and not for those of {}", option));
    if (sequence.turntable == 0 && o.reading.selection.seconds)
        throw UsageError("--at is one moment, --frames are many");
}

} // namespace stromboli

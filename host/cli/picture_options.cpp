// Options: which scene, and which part of which picture of it.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/core/number_text.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

/// Larger pictures than this on a side are taken for mistakes.
constexpr Range<double> kStops{-100, 100};
constexpr Range<uint32_t> kSide{1, 65536};
constexpr Range<uint32_t> kPlace{0, 65535};
constexpr Range<uint32_t> kSceneNumbers{0, 0xFFFFFFFEu};
constexpr Range<uint32_t> kTextureSides{0, 65536};
constexpr Range<double> kAnimationSeconds{0, 1e9};

Crop readCrop(const std::string& name, const Words& words) {
    return {readNumber(name + ": left", words[0], kPlace),
            readNumber(name + ": top", words[1], kPlace),
            readNumber(name + ": width", words[2], kSide),
            readNumber(name + ": height", words[3], kSide)};
}

/// Radiance: one number for all channels, or three with commas between. Empty if it is no such
/// text.
std::optional<glm::vec3> readRadiance(const std::string& word) {
    const size_t first = word.find(','), second = word.find(',', first + 1);
    const auto channel = [](const std::string& text) -> std::optional<float> {
        const std::optional<double> value = realNumber(text);
        if (!value || *value < 0 || *value > 1e30) return std::nullopt;
        return float(*value);
    };
    if (first == std::string::npos) {
        const std::optional<float> grey = channel(word);
        return grey ? std::optional(glm::vec3(*grey)) : std::nullopt;
    }
    if (second == std::string::npos) return std::nullopt;
    const std::optional<float> r = channel(word.substr(0, first)),
                               g = channel(word.substr(first + 1, second - first - 1)),
                               b = channel(word.substr(second + 1));
    return r && g && b ? std::optional(glm::vec3(*r, *g, *b)) : std::nullopt;
}

/// One of the words of CameraChoice, else the name or number of a camera of the file.
CameraRequest readCamera(const std::string& word) {
    if (word.empty()) throw UsageError("--camera is empty: expected text");
    if (const std::optional<CameraChoice> choice = valueNamed<CameraChoice>(word)) return *choice;
    return {CameraChoice::File, word};
}

/// The cameras that a word names if it names several: "all", or names and numbers with commas.
Words readCameras(const std::string& word) {
    if (word == "all") return {word};
    Words cameras;
    if (word.find(',') == std::string::npos) return cameras;
    for (size_t first = 0, end = 0; end != std::string::npos; first = end + 1) {
        end = word.find(',', first);
        cameras.push_back(word.substr(first, end - first));
        if (cameras.back().empty())
            refuse("--camera", word, "names or numbers of cameras with commas between");
    }
    return cameras;
}

Words withAll(Words names) {
    names.emplace_back("all");
    return names;
}

} // namespace

void declareScene(DeclaredCommand& c) {
    c.list.group("Scene");
    c.list
        .text(
            "SCENE", "",
            "COLLADA (.dae, .zae), glTF (.gltf, .glb), Mitsuba (.xml), OBJ, PLY, or by Assimp STL, "
            "FBX, 3DS, ... file; or a "
            "bundled scene by its name "
            "(cornell_boxes, island, "
            "...); or generate:cornell_mesh:N for a scene of N triangles made in memory, "
            "generate:lamps:N for one lit by N triangles, generate:forest:N for N trees that "
            "are instances",
            c.options.scene)
        .required()
        .proposes(Proposed::Scenes);
    SceneConventions& reading = c.options.reading;
    c.list
        .onOff("--default-light",
               "on: a plain sky lights a file without any light; off: it stays black",
               reading.defaultLight)
        .usually("on; --cs184: off");
    EnvironmentRequest& environment = c.options.environment;
    c.list
        .words("--env", "FILE",
               "light from all around: an equirectangular picture (.hdr, .exr, ...), the bundled "
               "evening_sky, or its radiance as a number or as R,G,B; takes the place of ambient "
               "light and is seen by the camera",
               1,
               [&environment](const Words& words) {
                   if (words[0].empty()) throw UsageError("--env is empty: expected text");
                   environment.constant = readRadiance(words[0]);
                   environment.file = environment.constant ? "" : words[0];
               })
        .excludes("--cs184")
        .proposes(Proposed::Files);
    c.list
        .real("--env-rotate", "DEGREES",
              "turns it about the vertical, counter-clockwise seen from above",
              environment.rotationDegrees, {-3600, 3600})
        .needs("--env");
    c.list.real("--env-strength", "X", "multiplies its radiance", environment.strength, {0, 1e9})
        .needs("--env");
    FileSelection& selection = reading.selection;
    c.list
        .words("--scene", "N", "glTF: the scene of this number, from 0", 1,
               [&selection](const Words& words) {
                   selection.scene = readNumber("--scene", words[0], kSceneNumbers);
               })
        .usually("the file's own choice")
        .from(inWords(kSceneNumbers));
    c.list.text("--variant", "NAME", "glTF: the set of materials of this name", selection.variant);
    c.list
        .words("--at", "SECONDS", "glTF: the pose that the first animation has at this time", 1,
               [&selection](const Words& words) {
                   selection.seconds = readReal("--at", words[0], kAnimationSeconds);
               })
        .usually("the pose without animation")
        .from(inWords(kAnimationSeconds));
    c.list
        .words(
            "-D,--define", "NAME=VALUE",
            "Mitsuba: the value of $NAME in the scene, in place of its <default>; may be repeated",
            1,
            [&selection](const Words& words) {
                for (const std::string& word : words) {
                    const size_t equals = word.find('=');
                    if (equals == 0 || equals == std::string::npos)
                        refuse("-D", word, "NAME=VALUE");
                    selection.definitions.push_back(
                        {word.substr(0, equals), word.substr(equals + 1)});
                }
            })
        .mayRepeat = true;
    c.list.number("--max-texture", "N",
                  "halves pictures on surfaces until no side has more pixels; 0: never",
                  selection.largestTexture, kTextureSides);
    c.list.choice(
        "--instances", "HOW",
        "what meshes that a file shows several times do with their triangles; sharing takes "
        "less memory, copies are faster",
        reading.instances);
    c.list.flag("--strict",
                "what breaks the rules of the scene's format or cannot be read is an error, also "
                "where it is clear "
                "what is meant",
                reading.strict);
}

void declarePictureFile(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.real("--exposure", "EV", "PNG: radiance times 2^EV", o.tone.exposure, kStops);
    c.list.flag("--aov", "EXR: also sample counts and variances of the mean", o.statisticsChannels);
    c.list
        .onOff("--notes",
               "on: the picture's file says of which scene it is, with which seed, samples, "
               "version, device and command it was made (info shows it); off: it does not",
               o.notes)
        .besidePicture();
}

void declarePicture(DeclaredCommand& c) {
    c.list.group("Picture");
    Options& o = c.options;
    c.list
        .words("-r,--size", "W H", "picture size", 2,
               [&o](const Words& words) {
                   o.area.width = readNumber("-r: width", words[0], kSide);
                   o.area.height = readNumber("-r: height", words[1], kSide);
                   o.sizeGiven = true;
               })
        .from(inWords(kSide))
        .usually(o.sizeGiven ? fmt::format("{} {}", o.area.width, o.area.height)
                             : "the camera's shape, 800 wide");
    c.list
        .words("--camera", "WHICH",
               fmt::format("whose view ({}; NAME or N: the file's camera of that name or number, "
                           "which info lists{})",
                           allMeanings<CameraChoice>(),
                           o.command == Command::Render
                               ? "; all, or several with commas, 1,3: a picture of each, "
                                 "OUT.NAME.png or, where a name is not plain (letters, digits, - "
                                 "and _) or not the only one, OUT.N.png"
                               : ""),
               1,
               [&o](const Words& words) {
                   const CameraRequest which = readCamera(words[0]);
                   o.camera.choice = which.choice;
                   o.camera.name = which.name;
                   o.cameras = readCameras(words[0]);
               })
        .usually(nameOf(o.camera.choice))
        .proposes(o.command == Command::Render ? withAll(namesOf<CameraChoice>())
                                               : namesOf<CameraChoice>());
    declareOptics(c);
    const std::string placeAndSize = fmt::format("{} and {}", inWords(kPlace), inWords(kSide));
    c.list
        .words("--crop", "X Y W H", "only this part: left, top, width, height in pixels", 4,
               [&o](const Words& words) { o.area.crop = readCrop("--crop", words); })
        .from(placeAndSize);
    c.list
        .words("--cell", "X Y W H", "the same with Y from the bottom (CS184's -p)", 4,
               [&c](const Words& words) { c.asked.cell = readCrop("--cell", words); })
        .from(placeAndSize)
        .excludes("--crop");
}

void finishPicture(DeclaredCommand& c) {
    Options& o = c.options;
    if (o.command != Command::Render && o.cameras == Words{"all"})
        throw UsageError(fmt::format("--camera all: {} is of one picture; only render makes one of "
                                     "each camera",
                                     c.name));
    if (!c.asked.cell) return;
    const Crop& cell = *c.asked.cell;
    o.sizeGiven = true; // 800 x 600, unless the user gave another
    if (uint64_t(cell.y) + cell.height > o.area.height)
        throw UsageError(fmt::format("-p: the cell ends at row {} of {}",
                                     uint64_t(cell.y) + cell.height, o.area.height));
    o.area.crop = cell;
    o.area.crop.y = o.area.height - cell.y - cell.height;
}

} // namespace stromboli

// Options: which scene, and which part of which picture of it.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

/// Larger pictures than this on a side are taken for mistakes.
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

/// One of the words of CameraChoice, else the name or number of a camera of the file.
CameraRequest readCamera(const std::string& word) {
    if (word.empty()) throw UsageError("--camera is empty: expected text");
    if (const std::optional<CameraChoice> choice = valueNamed<CameraChoice>(word)) return *choice;
    return {CameraChoice::File, word};
}

} // namespace

void declareScene(DeclaredCommand& c) {
    c.list.group("Scene");
    c.list
        .text("SCENE", "",
              "COLLADA (.dae, .zae) or glTF file (.gltf, .glb); or a bundled scene by its name "
              "(cornell_boxes, island, "
              "...); or generate:cornell_mesh:N for a scene of N triangles made in memory, "
              "generate:lamps:N for one lit by N triangles",
              c.options.scene)
        .required()
        .proposes(Proposed::Scenes);
    SceneConventions& reading = c.options.reading;
    c.list
        .words("--default-light", "WHETHER",
               "on: a plain sky lights a file without any light; off: it stays black", 1,
               [&reading](const Words& words) {
                   if (words[0] != "on" && words[0] != "off")
                       refuse("--default-light", words[0], "on or off");
                   reading.defaultLight = words[0] == "on";
               })
        .usually("on; --cs184: off")
        .proposes({"on", "off"});
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
    c.list.number("--max-texture", "N",
                  "halves pictures on surfaces until no side has more pixels; 0: never",
                  selection.largestTexture, kTextureSides);
    c.list.flag("--strict",
                "what breaks the rules of the scene's format is an error, also where it is clear "
                "what is meant",
                reading.strict);
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
                           "which info lists)",
                           allMeanings<CameraChoice>()),
               1, [&o](const Words& words) { o.camera = readCamera(words[0]); })
        .usually(nameOf(o.camera.choice))
        .proposes(namesOf<CameraChoice>());
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

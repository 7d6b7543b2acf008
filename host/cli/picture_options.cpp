// Options: which picture of a scene, and the file that it is written to.
#include "host/cli/declared_command.hpp"
#include "host/cli/sequence.hpp"
#include "host/core/error.hpp"
#include "host/core/text.hpp"
#include "host/engine/shadow_catcher.hpp"
#include "host/film/image_file.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace stromboli {
namespace {

/// Larger pictures than this on a side are taken for mistakes.
constexpr Range<uint32_t> kSide{1, 65536};
constexpr Range<uint32_t> kPlace{0, 65535};

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

/// The cameras that a word names if it names several: "all", or names and numbers with commas.
Words readCameras(const std::string& word) {
    if (word == "all") return {word};
    if (word.find(',') == std::string::npos) return {};
    const Words cameras = splitAtCommas(word);
    if (std::ranges::count(cameras, "") > 0)
        refuse("--camera", word, "names or numbers of cameras with commas between");
    return cameras;
}

Words withAll(Words names) {
    names.emplace_back("all");
    return names;
}

/// The scene's coordinates are below 2^60 metres (docs/theory/numerics.md).
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
    const std::optional<double> metres = quantityIn(word, kLengths);
    if (metres && *metres > 0 && *metres <= kCoordinates.most) return *metres;
    refuse(option, word,
           "a length greater than 0, in metres or with its unit: 5mm, 2.5cm, 3m, 1km");
}

/// A length, "auto", or the column and the row of a pixel with a comma between.
Focus readFocus(const std::string& word) {
    if (word == "auto") return Focus::onMiddle();
    const size_t comma = word.find(',');
    if (comma == std::string::npos) {
        const std::optional<double> metres = quantityIn(word, kLengths);
        if (metres && *metres > 0 && *metres <= kCoordinates.most) return *metres;
        refuse("--focus", word,
               "a length greater than 0 (2.5m), auto, or the column and the row of a pixel (320 "
               "180)");
    }
    return Focus::onPixel({readNumber("--focus: column", word.substr(0, comma), kPlace),
                           readNumber("--focus: row", word.substr(comma + 1), kPlace)});
}

std::vector<Layer> readLayers(const std::string& list) {
    std::vector<Layer> layers;
    for (const std::string& name : splitAtCommas(list)) {
        const std::optional<Layer> layer = valueNamed<Layer>(name);
        if (!layer) refuseName("--layers", name, namesOf<Layer>(), allNames<Layer>());
        if (std::ranges::count(layers, *layer) > 0)
            throw UsageError(fmt::format("--layers names {} twice", name));
        layers.push_back(*layer);
    }
    return layers;
}

/// Views that files do not state: where from, which angle, which lens.
void declareOptics(OptionList& list, CameraRequest& camera) {
    list.words("--look-from", "X Y Z", "look from this point instead of with a camera of the file",
               3, [&camera](const Words& words) { camera.from = readPoint("--look-from", words); })
        .from(inWords(kCoordinates))
        .excludes("--camera", "both say where from");
    list.words("--look-at", "X Y Z", "what --look-from looks at", 3,
               [&camera](const Words& words) { camera.at = readPoint("--look-at", words); })
        .from(inWords(kCoordinates))
        .needs("--look-from")
        .usually("the scene's middle");
    list.words("--fov", "DEGREES", "angle of view over the height of the picture", 1,
               [&camera](const Words& words) {
                   camera.fieldOfView =
                       readReal("--fov", words[0], kAngles, kDegrees) * glm::pi<double>() / 180;
               })
        .from(inWords(kAngles))
        .usually("the camera's; --look-from: 40");
    list.words(
            "--aperture", "LENGTH", "diameter of a thin lens (5mm): blurs what is out of focus", 1,
            [&camera](const Words& words) { camera.aperture = readLength("--aperture", words[0]); })
        .usually("a pinhole");
    list.words("--focus", "WHERE",
               "what a lens makes sharp: a distance from the camera, along its axis (2.5m); auto: "
               "what is in the middle of the picture; or X Y: what this pixel shows",
               1, [&camera](const Words& words) { camera.focus = readFocus(words[0]); })
        .usually("--aperture: auto; else as the camera says")
        .maybeApart()
        .proposes(Words{"auto"});
}

} // namespace

Words splitAtCommas(const std::string& word) {
    Words pieces;
    for (size_t first = 0, end = 0; end != std::string::npos; first = end + 1) {
        end = word.find(',', first);
        pieces.push_back(word.substr(first, end - first));
    }
    return pieces;
}

void declarePictureFile(OptionList& list, OutputOptions& o, ToneMapping& tone) {
    declareToneMapping(list, tone, o.encoding);
    list.group("Output");
    list.flag("--aov", "EXR: also sample counts and variances of the mean", o.statisticsChannels);
    declareNotes(list, o);
}

Words pictureFileOptions() {
    Words names = toneMappingOptions();
    names.insert(names.end(), {"--aov", "--notes"});
    return names;
}

Words partsOfPictureFile(const Words& command) {
    const Words names = pictureFileOptions();
    Words parts;
    for (const std::string& part : command)
        if (std::ranges::count(names, part.substr(0, part.find(' '))) > 0) parts.push_back(part);
    return parts;
}

void declareNotes(OptionList& list, OutputOptions& o) {
    list.onOff("--notes",
               "on: the picture's file says of which scene it is, with which seed, samples, "
               "version, device and command it was made (info shows it); off: it does not",
               o.notes)
        .besidePicture();
}

void declareSeen(OptionList& list, RenderRequest& o) {
    list.group("Output");
    list.flag("--transparent",
              "the picture has alpha: what no surface covers is transparent, and the camera does "
              "not see the environment, which lights the scene all the same",
              o.transparent);
    list.flag("--shadow-catcher",
              "puts a floor under all there is (--ground) that is not in the picture, but whose "
              "shadows, and the light that objects throw on it, are: in alpha, or on the "
              "--background",
              [&o] { o.shadowCatcher = kGroundName; })
        .excludes("--share", "films have no place for it");
    list.words("--shadows-on", "NAME",
               "as --shadow-catcher, on this object of the scene, or on all that has this "
               "material, in place of a floor",
               1,
               [&o](const Words& words) {
                   if (words[0].empty()) throw UsageError("--shadows-on is empty: expected text");
                   o.shadowCatcher = words[0];
               })
        .excludes("--shadow-catcher", "both say what the shadows fall on")
        .excludes("--share", "films have no place for it");
    list.words("--background", "COLOR",
               "what is seen where no surface is, in place of the environment, which lights the "
               "scene all the same: a radiance as a number or as R,G,B, or a picture's file, which "
               "covers the frame",
               1,
               [&o](const Words& words) {
                   const std::optional<glm::vec3> color = readRadiance(words[0]);
                   try {
                       o.background = color ? Background{1, 1, {*color}} : backgroundFrom(words[0]);
                   } catch (const SceneError& error) {
                       throw UsageError(fmt::format("--background is '{}': expected a radiance, "
                                                    "as a number or R,G,B, or a picture: {}",
                                                    words[0], error.what()));
                   }
               })
        .excludes("--transparent")
        .excludes("--share", "films have no place for it")
        .proposes(Proposed::Files);
    list.words(
            "--layers", "LIST",
            fmt::format("EXR: also these channels, with commas between (docs/guide/layers.md): {}",
                        allMeanings<Layer>()),
            1, [&o](const Words& words) { o.layers = readLayers(words[0]); })
        .proposes(namesOf<Layer>());
}

void finishSeen(const DeclaredCommand& c, SceneRequest& scene, RenderRequest& picture) {
    if (c.has("--shadow-catcher")) scene.ground.isGiven = true;
    if (picture.shadowCatcher) picture.transparent = !picture.background;
}

void checkOutputOptions(const DeclaredCommand& c, const OutputOptions& o,
                        const RenderRequest& picture) {
    const bool isExr = !isToneMapped(o.file);
    if (o.statisticsChannels && !isExr)
        throw UsageError(fmt::format("--aov needs an EXR file: {} has no channels for it", o.file));
    if (!picture.layers.empty() && !isExr)
        throw UsageError(fmt::format(
            "--layers needs an EXR file (-o name.exr): {} has no channels for them", o.file));
    if (picture.transparent && formatOf(o.file) == PictureFormat::Jpeg)
        throw UsageError(fmt::format("{}: {} is a JPEG, which has no alpha: write .png, .webp or "
                                     ".exr{}",
                                     picture.shadowCatcher ? "--shadow-catcher" : "--transparent",
                                     o.file,
                                     picture.shadowCatcher ? ", or give a --background" : ""));
    checkToneMapping(c, o);
}

void declarePicture(OptionList& list, RenderRequest& picture, Asked& asked, bool several) {
    list.group("Picture");
    list.words("-r,--size", "W H", "picture size", 2,
               [&picture](const Words& words) {
                   picture.size = {readNumber("-r: width", words[0], kSide),
                                   readNumber("-r: height", words[1], kSide)};
               })
        .from(inWords(kSide))
        .usually(picture.size ? fmt::format("{} {}", picture.size->width, picture.size->height)
                              : "the camera's shape, 800 wide")
        .maybeJoined();
    list.words("--camera", "WHICH",
               fmt::format("whose view ({}; NAME or N: the file's camera of that name or number, "
                           "which info lists{})",
                           allMeanings<CameraChoice>(),
                           several ? "; all, or several with commas, 1,3: a picture of each, "
                                     "OUT.NAME.png or, where a name is not plain (letters, digits, "
                                     "- and _) or not the only one, OUT.N.png"
                                   : ""),
               1,
               [&picture, &asked](const Words& words) {
                   const CameraRequest which = readCamera(words[0]);
                   picture.camera.choice = which.choice;
                   picture.camera.name = which.name;
                   asked.cameras = readCameras(words[0]);
               })
        .usually(nameOf(picture.camera.choice))
        .proposes(several ? withAll(namesOf<CameraChoice>()) : namesOf<CameraChoice>());
    declareOptics(list, picture.camera);
    const std::string placeAndSize = fmt::format("{} and {}", inWords(kPlace), inWords(kSide));
    list.words("--crop", "X Y W H", "only this part: left, top, width, height in pixels", 4,
               [&picture](const Words& words) { picture.crop = readCrop("--crop", words); })
        .from(placeAndSize);
    list.words("--cell", "X Y W H", "the same with Y from the bottom", 4,
               [&asked](const Words& words) { asked.cell = readCrop("--cell", words); })
        .from(placeAndSize)
        .excludes("--crop");
}

void finishPicture(const DeclaredCommand& c, RenderRequest& picture, const Asked& asked,
                   bool several) {
    if (!several && asked.cameras == Words{"all"})
        throw UsageError(fmt::format("--camera all: {} is of one picture; only render makes one of "
                                     "each camera",
                                     c.name));
    if (!asked.cell) return;
    const Crop& cell = *asked.cell;
    if (!picture.size) picture.size = PictureSize{}; // 800 x 600
    const uint32_t height = picture.size->height;
    if (uint64_t(cell.y) + cell.height > height)
        throw UsageError(fmt::format("-p: the cell ends at row {} of {}",
                                     uint64_t(cell.y) + cell.height, height));
    picture.crop = cell;
    picture.crop.y = height - cell.y - cell.height;
}

void declareSequence(OptionList& list, SequenceOptions& sequence) {
    list.number(
            "--turntable", "N",
            "N pictures, from cameras all around the scene: each is turned by a further N-th of "
            "a turn, counter-clockwise seen from above, about the vertical axis through its middle",
            sequence.turntable, {1, kFrameNumbers.most})
        .usually("one picture");
    list.words(
            "--frames", "A..B",
            "a picture of each of these frames: of the file's first animation (glTF), or of "
            "--turntable; OUT.0007.png, or as a pattern says: -o out%04d.png",
            1,
            [&sequence](const Words& words) { sequence.frames = readFrames("--frames", words[0]); })
        .usually("all of --turntable");
    list.real("--fps", "F", "frames of an animation in a second", sequence.framesPerSecond,
              {1e-3, 1e6})
        .needs("--frames");
}

} // namespace stromboli

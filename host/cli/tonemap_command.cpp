// `tonemap`: a picture of radiance becomes one for a screen.
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/printable.hpp"
#include "host/film/image_file.hpp"
#include "host/version/version.hpp"
#include "scene/images/float_image.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

namespace stromboli {
namespace {

/// What the picture's own file says of the render, which is as true of what is made from it.
PictureNotes notesOfRender(const std::string& picture) {
    if (!namesPicture(picture)) return {};
    constexpr std::array<std::string_view, 5> kOfRender = {"Scene", "Seed", "Samples", "Noise",
                                                           "Device"};
    PictureNotes notes;
    try {
        notes = readPictureNotes(picture);
    } catch (const UsageError&) {
        return {}; // its name and its kind differ
    }
    std::erase_if(notes, [&](const PictureNote& note) {
        return std::ranges::count(kOfRender, note.name) == 0;
    });
    return notes;
}

PictureNotes notesOf(const TonemapOptions& o) {
    if (!o.output.notes) return {};
    PictureNotes notes = {{"Software", fmt::format("Stromboli {}", version())},
                          {"Picture", printable(o.picture)}};
    for (PictureNote& note : notesOfRender(o.picture))
        notes.push_back({note.name, printable(note.text)});
    notes.push_back({"Command", printable(fmt::format("{}", fmt::join(o.command, " ")))});
    return notes;
}

/// The picture has a channel A if it is transparent anywhere.
FloatImage channelsOf(const images::RadiancePicture& picture) {
    FloatImage image(PictureArea{picture.wholeWidth,
                                 picture.wholeHeight,
                                 {picture.left, picture.top, picture.width, picture.height}});
    const auto fill = [&](const char* name, int channel) {
        std::vector<float>& values = image.channel(name);
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = picture.texels[i][channel];
    };
    for (int c = 0; c < 3; ++c)
        fill(kColorChannels[c], c);
    if (picture.isTransparent()) fill(kAlphaChannel, 3);
    return image;
}

} // namespace

void declareTonemap(DeclaredCommand& c) {
    const auto owned = std::make_shared<TonemapOptions>();
    TonemapOptions& o = *owned;
    c.list.group("Picture");
    c.list
        .text("IN", "", "the picture: .exr, .hdr or .pfm (radiance); or one for a screen, as sRGB",
              o.picture)
        .required()
        .proposes(Proposed::Files);
    c.list
        .text("--layer", "NAME",
              "EXR: the channels NAME.R, NAME.G, NAME.B, and NAME.A where there is one", o.layer)
        .usually("R, G, B and A; else the layer that looks most like the picture");
    c.list.group("Output");
    c.list.text("-o,--output", "FILE", "picture to write: .png, .jpg or .webp", o.output.file)
        .required()
        .besidePicture()
        .proposes(Proposed::Files);
    declareToneMapping(c.list, o.tone, o.output.encoding);
    c.list.group("Output");
    declareNotes(c.list, o.output);
    declareHost(c);
    c.finish = [&c, owned] {
        const std::string& file = owned->output.file;
        if (!isToneMapped(file))
            throw UsageError(fmt::format("{}: tonemap makes pictures for a screen, whose names end "
                                         "in .png, .jpg, .jpeg or .webp",
                                         file));
        checkToneMapping(c, owned->output);
        if (file == owned->picture)
            throw UsageError(file + ": the output would replace the picture that is read");
        owned->command = c.pictureCommand;
        return *owned;
    };
}

int tonemapCommand(const TonemapOptions& o) {
    const std::string& file = o.output.file;
    checkWritable(file);
    nowDoing("reading " + o.picture);
    const images::RadiancePicture picture = images::readRadiance(o.picture, o.layer);
    for (const images::PictureFault& fault : picture.faults)
        logging::warn(fmt::format("{}: {}", o.picture, fault.problem));
    const FloatImage radiance = channelsOf(picture);
    const bool hasAlpha = radiance.channels.contains(kAlphaChannel);
    if (hasAlpha && formatOf(file) == PictureFormat::Jpeg)
        throw UsageError(fmt::format("{} is a JPEG, which has no alpha, and {} is transparent in "
                                     "places: write .png or .webp",
                                     file, o.picture));
    checkPictureSize(file, picture.width, picture.height);
    nowDoing("writing " + file);
    PictureOptions options{o.tone, false, {}, o.output.encoding};
    if (hasAlpha) options.channels.emplace_back(kAlphaChannel);
    const PictureNotes notes = notesOf(o);
    if (!isStandardOutput(file))
        checkFreeSpace(file,
                       largestPictureFile(file, picture.width, picture.height, options, notes));
    sayWhatWasMetered(o.tone, writeToneMapped(file, radiance, options, notes));
    return 0;
}

} // namespace stromboli

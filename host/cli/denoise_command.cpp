// `denoise`: a picture of radiance without its noise.
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/printable.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

namespace stromboli {
namespace {

PictureNotes notesOf(const DenoiseOptions& o) {
    if (!o.output.notes) return {};
    return {{"Software", fmt::format("Stromboli {}", version())},
            {"Picture", printable(o.picture)},
            {"Command", printable(fmt::format("{}", fmt::join(o.command, " ")))}};
}

/// Red, green and blue of the denoised picture, in its place in the whole, and alpha if there is
/// any; with `more`, all that the file had beside, the noisy picture and the predicted error.
FloatImage outputOf(const FloatImage& read, const denoise::NoisyPicture& noisy,
                    const denoise::DenoisedPicture& denoised, bool more) {
    FloatImage image(read.area);
    if (more) image.channels = read.channels;
    if (const auto alpha = read.channels.find(kAlphaChannel); alpha != read.channels.end())
        image.channels.insert(*alpha);
    for (int c = 0; c < 3; ++c) {
        std::vector<float>& channel = image.channel(kColorChannels[c]);
        for (size_t i = 0; i < channel.size(); ++i)
            channel[i] = denoised.mean[i][c];
    }
    if (more) denoise::addChannels(image, noisy, denoised);
    return image;
}

/// Open Image Denoise needs no Vulkan device.
denoise::DenoisedPicture denoised(const denoise::NoisyPicture& noisy, const DenoiseOptions& o) {
    if (o.denoiser == Denoiser::Oidn) return denoise::denoisePicture(noisy, o.denoiser, nullptr);
    const vulkan::OpenDevice open = vulkan::openDevice(o.device, toTerminal().message);
    denoise::DenoisedPicture result = denoise::denoisePicture(noisy, o.denoiser, open.device.get());
    vulkan::requireNoValidationMessages(open);
    return result;
}

void write(const DenoiseOptions& o, const FloatImage& image) {
    const std::string& file = o.output.file;
    const PictureNotes notes = notesOf(o);
    if (!isToneMapped(file)) return writeExr(file, image, notes);
    PictureOptions options{o.tone, false, {}, o.output.encoding};
    if (image.channels.contains(kAlphaChannel)) options.channels.emplace_back(kAlphaChannel);
    sayWhatWasMetered(o.tone, writeToneMapped(file, image, options, notes));
}

} // namespace

void declareDenoise(DeclaredCommand& c) {
    const auto owned = std::make_shared<DenoiseOptions>();
    DenoiseOptions& o = *owned;
    c.list.group("Picture");
    c.list
        .text("IN.exr", "",
              "the picture: R, G, B, with variance.R, .G, .B (render --aov) or halfA.R, ... and "
              "halfB.R, ...; albedo, normal and depth where there are any (docs/guide/denoise.md)",
              o.picture)
        .required()
        .proposes(Proposed::Files);
    c.list
        .words("--with", "WHICH", "the denoiser: on, which is the program's own, or oidn", 1,
               [&o](const Words& words) {
                   const auto which = valueNamed<Denoiser>(words[0]);
                   if (!which || *which == Denoiser::Off) refuse("--with", words[0], "on or oidn");
                   o.denoiser = *which;
               })
        .usually("on")
        .proposes({"on", "oidn"});
    c.list.group("Output");
    c.list
        .text("-o,--output", "FILE",
              "picture to write: .png, .jpg, .webp, or .exr, which has the predicted error too",
              o.output.file)
        .required()
        .besidePicture()
        .proposes(Proposed::Files);
    declareToneMapping(c.list, o.tone, o.output.encoding);
    c.list.group("Output");
    declareNotes(c.list, o.output);
    declareDevice(c.list, o.device);
    declareHost(c);
    c.finish = [&c, owned] {
        const std::string& file = owned->output.file;
        checkToneMapping(c, owned->output);
        if (file == owned->picture)
            throw UsageError(file + ": the output would replace the picture that is read");
        owned->command = c.pictureCommand;
        return *owned;
    };
}

int denoiseCommand(const DenoiseOptions& o) {
    const std::string& file = o.output.file;
    denoise::requireUsable(o.denoiser);
    checkWritable(file);
    nowDoing("reading " + o.picture);
    const FloatImage read = readExr(o.picture);
    const denoise::NoisyPicture noisy = denoise::noisyPictureOf(read, o.picture);
    checkPictureSize(file, read.width, read.height);
    nowDoing("denoising");
    const denoise::DenoisedPicture clean = denoised(noisy, o);
    nowDoing("writing " + file);
    write(o, outputOf(read, noisy, clean, !isToneMapped(file)));
    logDenoised(clean.summary);
    return 0;
}

} // namespace stromboli

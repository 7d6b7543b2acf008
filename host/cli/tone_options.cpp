// Options: how radiance becomes a picture for a screen.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/core/text.hpp"
#include "host/film/image_file.hpp"
#include "host/film/white_balance.hpp"

#include <fmt/format.h>

#include <string>

namespace stromboli {
namespace {

constexpr const char* kAutomatic = "auto";
constexpr Range<double> kStops{-100, 100};
constexpr Range<double> kKelvin{kLeastKelvin, kMostKelvin};
constexpr Range<uint32_t> kQuality{1, 100};

/// Nothing for the word auto. Throws UsageError that names the option, the range and the word.
std::optional<double> readRealOrAuto(const std::string& option, const std::string& word,
                                     Range<double> range) {
    if (word == kAutomatic) return std::nullopt;
    const std::optional<double> value = realNumber(word);
    if (!value || !(*value >= range.least && *value <= range.most))
        refuse(option, word, fmt::format("{} or a number from {}", kAutomatic, inWords(range)));
    return value;
}

uint32_t readBits(const std::string& word) {
    if (word == "8") return 8;
    if (word == "16") return 16;
    refuse("--bits", word, "8 or 16");
}

} // namespace

void declareToneMapping(OptionList& list, ToneMapping& tone, PictureEncoding& encoding) {
    list.group("Pictures for a screen: all but EXR");
    list.choice("--view", "HOW", "how radiance becomes the light of a screen", tone.view);
    list.words("--exposure", "EV",
               "radiance times 2^EV; auto: metered, so that the mean of the logarithms of what is "
               "neither background nor lamp is middle grey",
               1,
               [&tone](const Words& words) {
                   const auto stops = readRealOrAuto("--exposure", words[0], kStops);
                   tone.metersExposure = !stops;
                   tone.curve.exposure = stops.value_or(0);
               })
        .from(inWords(kStops))
        .usually("0")
        .proposes({kAutomatic});
    list.words("--white-balance", "KELVIN",
               "light of this temperature shows as white, as 3200 of lamps; auto: of that under "
               "which the picture is grey on the mean",
               1,
               [&tone](const Words& words) {
                   tone.illuminant = readRealOrAuto("--white-balance", words[0], kKelvin);
                   tone.metersIlluminant = !tone.illuminant;
               })
        .from(inWords(kKelvin))
        .usually("colours stay as they are")
        .proposes({kAutomatic});
    list.onOff("--dither",
               "on: what lies between two of the 256 steps becomes a fine pattern of both, so that "
               "slow gradients show no bands",
               encoding.dithers);
    list.words("--bits", "N", "PNG: bits of a channel, 8 or 16", 1,
               [&encoding](const Words& words) { encoding.bits = readBits(words[0]); })
        .usually("8")
        .proposes({"8", "16"});
    list.number("--quality", "N", "JPEG and WebP: from small to good; of WebP 100 is without loss",
                encoding.quality, kQuality);
}

const Words& toneMappingOptions() {
    static const Words kNames = {"--view",   "--exposure", "--white-balance",
                                 "--dither", "--bits",     "--quality"};
    return kNames;
}

void checkToneMapping(const DeclaredCommand& c, const OutputOptions& o) {
    const PictureFormat format = formatOf(o.file);
    const std::string given = c.givenOf(toneMappingOptions());
    if (format == PictureFormat::Exr && !given.empty())
        throw UsageError(fmt::format("{} is for pictures of a screen (.png, .jpg, .webp): {} holds "
                                     "radiance as it is, of which stromboli tonemap makes one",
                                     given, o.file));
    if (o.encoding.bits == 16 && format != PictureFormat::Png)
        throw UsageError(fmt::format("--bits 16 needs a PNG file: {} has 8 bits", o.file));
    if (o.encoding.bits == 16 && o.encoding.dithers)
        throw UsageError("--dither on is for 8 bits: with --bits 16 no step can be seen");
    if (c.has("--quality") && format == PictureFormat::Png)
        throw UsageError(fmt::format(
            "--quality is for JPEG and WebP: {} is a PNG, which is without loss", o.file));
}

} // namespace stromboli

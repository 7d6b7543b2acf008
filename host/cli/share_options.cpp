// Options: shares of a picture's samples, and putting them together.
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/farm/film_file.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

constexpr Range<uint32_t> kShares{1, 1'000'000};
constexpr Range<double> kStops{-100, 100};
const char* const kAllAlike = "a share has as many samples of every pixel as of all others";

ShareName readShare(const std::string& word) {
    const size_t slash = word.find('/');
    if (slash == std::string::npos) refuse("--share", word, "I/N, as 3/16");
    ShareName share;
    share.count = readNumber("--share: N", word.substr(slash + 1), kShares);
    share.index = readNumber("--share: I", word.substr(0, slash), {1, share.count});
    return share;
}

} // namespace

void declareShare(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.group("Shares of several machines");
    c.list
        .words("--share", "I/N",
               "take only the I-th of N parts of every pixel's samples and write them as a film "
               "(-o NAME.film), for stromboli merge; implies --even",
               1, [&o](const Words& words) { o.share = readShare(words[0]); })
        .implies("--even")
        .excludes("-a", kAllAlike)
        .excludes("--noise", kAllAlike)
        .excludes("--time", kAllAlike)
        .excludes("--checkpoint", "a share is what is kept: take more of them")
        .excludes("--checkpoint-every", "a share is what is kept: take more of them")
        .excludes("--transparent", "films of shares hold radiance alone")
        .excludes("--layers", "films of shares hold radiance alone; render the layers by "
                              "themselves, with -s 1")
        .excludes("--exposure", "merge has it")
        .excludes("--aov", "merge has it")
        .excludes("--notes", "merge has it")
        .excludes("--pixel")
        .besidePicture();
    c.list
        .text("--expect", "FINGERPRINT",
              "with --share: begin only if scene, camera and program are those of this "
              "fingerprint, which submit writes",
              o.expected)
        .needs("--share")
        .besidePicture();
}

void finishShare(DeclaredCommand& c) {
    const Options& o = c.options;
    if (!o.cameras.empty()) throw UsageError("--share is of one picture: --camera names several");
    if (!namesFilm(o.output))
        throw UsageError(
            fmt::format("{}: --share writes a film, whose name must end in .film", o.output));
}

void declareMerge(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.group("Films");
    c.list.list("FILM", "", "films that render --share or merge wrote, in any order", o.films)
        .required()
        .proposes(Proposed::Files);
    c.list.group("Output");
    c.list
        .text("-o,--output", "FILE",
              "picture to write: .png or .exr, with the bytes that a render in one go has; or a "
              ".film, to be merged with others",
              o.output)
        .required()
        .proposes(Proposed::Files);
    c.list.flag("--complete", "write nothing, and fail, if shares are missing", o.wantsAllShares);
    c.list.real("--exposure", "EV", "PNG: radiance times 2^EV", o.tone.exposure, kStops);
    c.list.flag("--aov", "EXR: also sample counts and variances of the mean", o.statisticsChannels);
    c.list
        .words("--notes", "WHETHER",
               "on: the picture's file says how it was made; off: it does not", 1,
               [&o](const Words& words) {
                   if (words[0] != "on" && words[0] != "off")
                       refuse("--notes", words[0], "on or off");
                   o.notes = words[0] == "on";
               })
        .usually("on")
        .proposes({"on", "off"});
    declareHost(c);
    c.finish = [&c, &o] {
        if (!namesFilm(o.output)) return checkOutputOptions(c);
        const std::string ofPictures = c.givenOf({"--exposure", "--aov", "--notes"});
        if (!ofPictures.empty())
            throw UsageError(fmt::format("{}: a film has no {}: say it when the picture is made",
                                         o.output, ofPictures));
    };
}

} // namespace stromboli

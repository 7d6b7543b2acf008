// Options of `render`.
#include "host/cli/declared_command.hpp"
#include "host/cli/presets.hpp"
#include "host/cli/sequence.hpp"
#include "host/cli/word_spelling.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/nearest_name.hpp"
#include "host/farm/film_file.hpp"
#include "host/film/image_file.hpp"

#include <fmt/format.h>

#include <memory>

namespace stromboli {
namespace {

constexpr Range<double> kSeconds{0.01, 1e9};
constexpr Range<uint32_t> kSampleNumbers{0, kMostSamples - 1};
constexpr Range<uint32_t> kShares{1, 1'000'000};
const char* const kAllAlike = "a share has as many samples of every pixel as of all others";

constexpr Range<double> kUpdateSeconds{0.1, 1e6};
constexpr Range<double> kProgressSeconds{1e-3, 1e9};

ShareName readShare(const std::string& word) {
    const size_t slash = word.find('/');
    if (slash == std::string::npos) refuse("--share", word, "I/N, as 3/16");
    ShareName share;
    share.count = readNumber("--share: N", word.substr(slash + 1), kShares);
    share.index = readNumber("--share: I", word.substr(0, slash), {1, share.count});
    return share;
}

void declareOutput(OptionList& list, RenderOptions& o) {
    list.group("Output");
    list.text(
            "-o,--output", "FILE",
            "picture to write: .png, .jpg or .webp (sRGB), or .exr (linear); -: a PNG on standard "
            "output; with --share a .film",
            o.output.file)
        .besidePicture()
        .proposes(Proposed::Files);
    declarePictureFile(list, o.output, o.tone);
    declareSeen(list, o.picture);
    list.choice("--denoise", "[WHICH]",
                "what takes the noise out of the picture that is finished (docs/guide/denoise.md); "
                "without WHICH: on",
                o.picture.denoiser)
        .maybeWithout("on",
                      [](const std::string& word) {
                          return nearestName(word, namesOf<Denoiser>()).has_value();
                      })
        .excludes("--share", "films of shares are put together first: stromboli denoise has it");
    list.text("--stats", "FILE.json",
              "write statistics of the render as JSON; - for standard output", o.output.statsFile)
        .besidePicture()
        .proposes(Proposed::Files);
}

/// FILE or FILE:SECONDS.
void readUpdate(const std::string& word, WatchOptions& o) {
    if (word.empty()) throw UsageError("--update is empty: expected FILE or FILE:SECONDS");
    const size_t colon = word.rfind(':');
    if (colon == std::string::npos) {
        o.updateFile = word;
        return;
    }
    o.updateFile = word.substr(0, colon);
    o.updateSeconds = readReal("--update: SECONDS", word.substr(colon + 1), kUpdateSeconds, kTimes);
}

ProgressRequest readProgress(const std::string& word) {
    if (word == "auto") return {};
    if (word == "off") return {ProgressForm::Off};
    if (word == "json") return {ProgressForm::Objects, 1};
    const std::optional<double> seconds = quantityIn(word, kTimes);
    if (!seconds || !(*seconds >= kProgressSeconds.least && *seconds <= kProgressSeconds.most))
        refuse("--progress", word, "auto, json, off, or how often lines come, as 30s");
    return {ProgressForm::Lines, *seconds};
}

void declareWatching(OptionList& list, WatchOptions& o, ProgressRequest& progress) {
    list.group("Watching");
    list.words("--progress", "HOW",
               "how it is said how far the render is: auto: a bar on a terminal, elsewhere a line "
               "every 10 s; a time, as 30s: a line that often; json: a JSON object a line on "
               "standard error, every second and at the end; off: not at all",
               1, [&progress](const Words& words) { progress = readProgress(words[0]); })
        .usually("auto")
        .besidePicture()
        .proposes({"auto", "json", "off"});
    list.number("--watch", "[PORT]",
                "serve a page that shows the picture while it is rendered, on this machine alone; "
                "without a port at any that is free; the address is printed (docs/guide/view.md)",
                o.port, {0, 65535})
        .maybeWithout("0", isWholeNumber)
        .excludes("--share", "its picture is in several films")
        .besidePicture();
    list.words("--update", "FILE",
               "write the picture for a screen (.png, .jpg, .webp) again and again while it is "
               "rendered, each time complete; FILE:SECONDS says how often",
               1, [&o](const Words& words) { readUpdate(words[0], o); })
        .usually("every 5 seconds")
        .excludes("--share", "its picture is in several films")
        .besidePicture()
        .proposes(Proposed::Files);
    list.text("--tev", "ADDRESS",
              "send the picture to the image viewer tev at HOST:PORT while it is rendered; tev "
              "itself listens at 127.0.0.1:14158",
              o.tev)
        .excludes("--share", "its picture is in several films")
        .besidePicture();
}

void declareCheckpoints(OptionList& list, CheckpointOptions& o, bool& skipExisting) {
    list.group("Going on");
    list.text("--checkpoint", "FILE",
              "keep the state of the render there, and leave it at the end; off: nowhere", o.file)
        .usually("OUTPUT.checkpoint, from the first minute to the end of the render")
        .besidePicture()
        .proposes({"off"})
        .proposes(Proposed::Files);
    list.real("--checkpoint-every", "S", "seconds from one checkpoint to the next", o.everySeconds,
              kSeconds, kTimes)
        .besidePicture();
    list.flag("--resume",
              "go on from the checkpoint, to the same bytes as if never interrupted; also with "
              "another -s, --noise, --time or -a (--time counts all runs); of several pictures "
              "(--frames, --turntable, --camera) with the first that is not finished; with "
              "--share: the film of this share is kept if it is there",
              o.resume)
        .besidePicture();
    list.flag("--skip-existing",
              "leave out pictures whose file is there, unless a checkpoint says that they are not "
              "finished",
              skipExisting)
        .excludes("--share", "--resume keeps its film")
        .besidePicture();
}

void declareShare(OptionList& list, ShareOptions& o) {
    list.group("Shares of several machines");
    CommandOption& share =
        list.words("--share", "I/N",
                   "take only the I-th of N parts of every pixel's samples and write them as a "
                   "film (-o NAME.film), for stromboli merge; implies --even",
                   1, [&o](const Words& words) { o.share = readShare(words[0]); });
    for (const std::string& option : pictureFileOptions())
        share.excludes(option, "merge has it");
    share.implies("--even")
        .excludes("-a", kAllAlike)
        .excludes("--noise", "a share has as many samples of every pixel as of all others; "
                             "stromboli plan spreads those of further rounds")
        .excludes("--time", kAllAlike)
        .excludes("--checkpoint", "a share is what is kept: take more of them")
        .excludes("--checkpoint-every", "a share is what is kept: take more of them")
        .excludes("--pixel")
        .besidePicture();
    list.text("--plan", "FILE.plan",
              "with --share: a part of the samples of this round, which stromboli plan wrote; all "
              "other options are those of the first round",
              o.planFile)
        .needs("--share")
        .besidePicture()
        .proposes(Proposed::Files);
    list.text("--expect", "FINGERPRINT",
              "with --share: begin only if scene, camera and program are those of this "
              "fingerprint, which submit writes",
              o.expected)
        .needs("--share")
        .besidePicture();
}

/// They name a sample as the line about rejected samples does: added to the same command, they
/// explain that sample.
void declarePixelAlone(OptionList& list, Asked& asked) {
    list.group("One pixel explained");
    list.words("--pixel", "X Y",
               "no picture: the mean and the variance of this pixel (column, row from the top) by "
               "kernel and reference, and its heaviest samples",
               2,
               [&asked](const Words& words) {
                   constexpr Range<uint32_t> kPlaces{0, 65535};
                   asked.pixel.x = readNumber("--pixel", words[0], kPlaces);
                   asked.pixel.y = readNumber("--pixel", words[1], kPlaces);
                   asked.pixelAlone = true;
               })
        .besidePicture();
    list.words("--sample", "N",
               "with --pixel: this sample, the first being 0, and every vertex of its path: what "
               "the kernel does, and what the reference makes of the same path",
               1,
               [&asked](const Words& words) {
                   asked.pixel.sample = readNumber("--sample", words[0], kSampleNumbers);
               })
        .from(inWords(kSampleNumbers))
        .needs("--pixel")
        .besidePicture();
    list.text("--json", "FILE.json", "with --pixel: write all of it as JSON; - for standard output",
              asked.pixel.jsonFile)
        .needs("--pixel")
        .besidePicture()
        .proposes(Proposed::Files);
}

/// Each has files of its own.
void checkSeveralPictures(const RenderOptions& o) {
    if (o.cameras.empty()) return;
    if (o.pixelAlone) throw UsageError("--pixel is of one picture: --camera names several");
    if (isStandardOutput(o.output.file))
        throw UsageError("-o - has place for one picture: --camera names several");
    if (o.output.statsFile == "-")
        throw UsageError("--stats - has place for one picture's: --camera names several");
}

/// Each picture has files of its own.
void checkSequence(const RenderOptions& o) {
    const SequenceOptions& sequence = o.sequence;
    if (!sequence.isGiven()) return;
    const char* option = sequence.turntable > 0 ? "--turntable" : "--frames";
    checkFrames(sequence, o.scene);
    if (!o.cameras.empty())
        throw UsageError(fmt::format("{} is of one camera: --camera names several", option));
    if (o.share.share && framesOf(sequence).size() > 1)
        throw UsageError(fmt::format("--share is of one picture, and not of {}: give it one frame, "
                                     "as --frames 7",
                                     option));
    if (o.pixelAlone)
        throw UsageError(fmt::format("--pixel is of one picture, and not of {}", option));
    if (o.output.file == "-" || o.output.statsFile == "-")
        throw UsageError(
            fmt::format("- has place for one picture, and not for those of {}", option));
}

void checkShare(const RenderOptions& o) {
    if (!o.cameras.empty()) throw UsageError("--share is of one picture: --camera names several");
    if (!namesFilm(o.output.file))
        throw UsageError(
            fmt::format("{}: --share writes a film, whose name must end in .film", o.output.file));
}

/// What is given and has no effect here: said, and not refused, because these options are added to
/// command lines that are there already.
void remarkOnWhatIsIgnored(DeclaredCommand& c, const RenderOptions& o) {
    std::vector<std::string>& remarks = c.host.remarks;
    Words ofPictures = pictureFileOptions();
    ofPictures.insert(ofPictures.end(), {"-o", "--stats", "--layers", "--crop", "--cell"});
    const std::string ignored = o.pixelAlone ? c.givenOf(ofPictures) : "";
    if (!ignored.empty())
        remarks.push_back(
            fmt::format("--pixel explains one pixel and makes no picture: ignored: {}", ignored));
    const PathBudget& budget = o.picture.budget;
    if (isStandardOutput(o.output.file) && (budget.adaptive.enabled || budget.stop.open()))
        remarks.emplace_back(
            "-o - has no place for a second picture: the rate picture is left out");
}

void finishRender(DeclaredCommand& c, RenderOptions& o, const Asked& asked) {
    finishPicture(c, o.picture, asked, true);
    finishEstimator(c, o, asked);
    finishBudget(o.picture, asked);
    o.cameras = asked.cameras;
    if (asked.pixelAlone) o.pixelAlone = asked.pixel;
    finishSeen(c, o.scene, o.picture);
    o.device.maybeSeveral = !asked.pixelAlone;
    o.device.threads = c.host.threads;
    o.command = c.pictureCommand;
    checkSeveralPictures(o);
    checkSequence(o);
    if (o.output.file.empty() && !o.pixelAlone)
        throw UsageError("--output is required (see --help)");
    if (o.device.backend == BackendChoice::Reference && c.has("--device"))
        throw UsageError("--device and --backend reference exclude each other: the reference "
                         "runs on the CPU, without Vulkan");
    if (o.share.share)
        checkShare(o);
    else if (!o.pixelAlone)
        checkOutputOptions(c, o.output, o.picture);
    o.picture.keepsNoisy = !o.share.share && !o.pixelAlone && !isToneMapped(o.output.file);
    remarkOnWhatIsIgnored(c, o);
}

} // namespace

void declareRender(DeclaredCommand& c) {
    const auto o = std::make_shared<RenderOptions>();
    const auto asked = std::make_shared<Asked>();
    asked->makes = Makes::Pictures;
    asked->maySpread = asked->branchesPay = true;
    OptionList& list = c.list;
    declareScene(list, o->scene);
    declareOutput(list, *o);
    declarePreset(list);
    declarePicture(list, o->picture, *asked, true);
    declareSequence(list, o->sequence);
    declareEstimator(list, *o, *asked);
    declareSamples(list, o->picture, *asked,
                   "samples per pixel, on the mean: they go where they help most (--even: to all "
                   "alike); with -a, --noise and --time the most a pixel gets");
    declareBranches(list, o->picture,
                    "4 where bounces make most of the noise, else 1 (docs/theory/estimator.md)");
    declareClamp(list, o->picture);
    declareSpreading(list, o->picture, *asked);
    declarePixelAlone(list, *asked);
    declareShare(list, o->share);
    declareCheckpoints(list, o->checkpoint, o->skipExisting);
    declareWatching(list, o->watch, o->progress);
    declareFilmMemory(list, o->device);
    list.choice("--backend", "WHICH", "what takes the samples", o->device.backend);
    declareDevice(list, o->device.device);
    list.choice("--scheduler", "WHICH",
                "what a device's lanes do next; the picture is the same (docs/theory/kernel.md)",
                o->device.scheduler)
        .besidePicture();
    declareHost(c);
    list.number("--accumulate", "N", "0 is --min-bounce equal to -m", asked->accumulate,
                {0, 0xFFFFFFFFu})
        .excludes("--min-bounce", "both say which bounces are left out")
        .hidden();
    c.finish = [&c, o, asked] {
        finishRender(c, *o, *asked);
        return *o;
    };
}

} // namespace stromboli

// Options: shares of a picture's samples, and putting them together.
#include "host/cli/command_line.hpp"
#include "host/cli/declared_command.hpp"
#include "host/core/error.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/plan_file.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

constexpr Range<uint32_t> kShares{1, 1'000'000};
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
        .excludes("--noise", "a share has as many samples of every pixel as of all others; "
                             "stromboli plan spreads those of further rounds")
        .excludes("--time", kAllAlike)
        .excludes("--checkpoint", "a share is what is kept: take more of them")
        .excludes("--checkpoint-every", "a share is what is kept: take more of them")
        .excludes("--exposure", "merge has it")
        .excludes("--aov", "merge has it")
        .excludes("--notes", "merge has it")
        .excludes("--pixel")
        .besidePicture();
    c.list
        .text("--plan", "FILE.plan",
              "with --share: a part of the samples of this round, which stromboli plan wrote; all "
              "other options are those of the first round",
              o.planFile)
        .needs("--share")
        .besidePicture()
        .proposes(Proposed::Files);
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
    declarePictureFile(c);
    declareHost(c);
    c.finish = [&c, &o] {
        if (!namesFilm(o.output)) return checkOutputOptions(c);
        const std::string ofPictures = c.givenOf({"--exposure", "--aov", "--notes"});
        if (!ofPictures.empty())
            throw UsageError(fmt::format("{}: a film has no {}: say it when the picture is made",
                                         o.output, ofPictures));
    };
}

void declarePlan(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.group("Films");
    c.list
        .list("FILM", "",
              "all films of the rounds until now, of render --share or merge, in any "
              "order",
              o.films)
        .required()
        .proposes(Proposed::Files);
    c.list.group("Output");
    c.list
        .text("-o,--output", "FILE.plan",
              "the plan of the next round, for render --plan; nothing is written, and the exit "
              "code is 7, if nothing is left to do",
              o.output)
        .required()
        .proposes(Proposed::Files);
    c.list.group("Sampling");
    declareNoise(c,
                 "the noise to reach, as of render: the square root of the picture's relMSE is at "
                 "most T (0.02: 2 %) in 95 of 100 renders",
                 o.budget.stop.noise)
        .required();
    c.list.number("-s,--samples", "N", "the most samples of a pixel, over all rounds",
                  c.asked.paths, {1, kMostSamples});
    declareHost(c);
    c.finish = [&c, &o] {
        if (!namesPlan(o.output))
            throw UsageError(
                fmt::format("{}: plan writes a plan, whose name must end in .plan", o.output));
        o.budget.mostPathsPerPixel = c.asked.paths;
    };
}

void declareSubmit(DeclaredCommand& c) {
    Options& o = c.options;
    SubmitOptions& submit = o.submit;
    c.asked.even = true;
    c.list.group("Scheduler");
    c.list.choice("SCHEDULER", "", "who gives the work to machines", submit.scheduler)
        .usually("")
        .required()
        .besidePicture();
    c.list
        .number("--shares", "N", "tasks: parts of every pixel's samples", submit.shares, {1, 1000})
        .required()
        .usually("")
        .besidePicture();
    declareNoise(c,
                 "sample in rounds, each where the films until then are noisy, until the picture's "
                 "noise is at most T, as of render; -s is the number of samples of the first one",
                 submit.noise)
        .besidePicture();
    c.list
        .number("--rounds", "K",
                "with --noise: at most so many rounds; each at most doubles the samples, once "
                "pixels have 8 of them",
                submit.rounds, {2, 100})
        .needs("--noise")
        .besidePicture();
    c.list
        .text("--job-time", "LIMIT", "most time of a task, as sbatch --time has it: 90, 2:00:00",
              submit.jobTime)
        .usually("the cluster's own")
        .besidePicture();
    c.list
        .words("--sbatch", "OPTION",
               "another option of sbatch, as --sbatch=--partition=gpu; may be repeated", 1,
               [&submit](const Words& words) {
                   for (const std::string& word : words)
                       if (!word.starts_with("-"))
                           refuse("--sbatch", word, "an option of sbatch, with its dashes");
                   submit.sbatch = words;
               })
        .besidePicture()
        .mayRepeat = true;
    c.list.text("--program", "FILE", "the program, as the nodes find it", submit.program)
        .usually("the file of this one")
        .besidePicture()
        .proposes(Proposed::Files);
    c.list.flag("--dry-run", "print the scripts and submit nothing", submit.dryRun).besidePicture();
    declareScene(c);
    c.list.group("Output");
    c.list
        .text(
            "-o,--output", "FILE",
            "picture to write, in a folder that all nodes share: .png or .exr; films, scripts and "
            "logs are put into FILE.shares",
            o.output)
        .required()
        .besidePicture()
        .proposes(Proposed::Files);
    declarePictureFile(c);
    declareSeen(c);
    declarePicture(c);
    declareEstimator(c);
    declareSamples(c,
                   "samples per pixel, the same number for all; with --noise in the first round");
    declareBranches(c, "4 where bounces make most of the noise, else 1 (docs/estimator.md)");
    declareBlock(c);
    declareFilmMemory(c);
    c.list.choice("--backend", "WHICH", "what takes the samples", o.backend);
    declareDevice(c);
    declareHost(c);
    c.finish = [&c, &o, &submit] {
        finishPicture(c);
        finishEstimator(c);
        finishBudget(c, true);
        if (!o.cameras.empty())
            throw UsageError("submit is of one picture: --camera names several");
        o.estimator.showsBackdrop = !o.transparent;
        checkOutputOptions(c);
        for (size_t i = 1; i < o.pictureCommand.size(); ++i) { // the first is the command's name
            const std::string& part = o.pictureCommand[i];
            const bool isOfMerge = part.starts_with("--exposure") || part == "--aov";
            (isOfMerge ? submit.merge : submit.render).push_back(part);
        }
        if (!o.notes) submit.merge.emplace_back("--notes off");
        if (c.has("--device")) submit.render.push_back("--device " + shellQuoted(o.device));
        if (c.has("-t")) submit.render.push_back(fmt::format("-t {}", o.threads));
        if (o.filmMebibytes)
            submit.render.push_back(fmt::format("--film-memory {}", *o.filmMebibytes));
    };
}

} // namespace stromboli

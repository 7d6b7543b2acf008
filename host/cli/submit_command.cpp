// `submit`: a picture goes to a scheduler, as shares and their merge; of several, each or its
// frames.
#include "host/checkpoint/checkpoint_file.hpp"
#include "host/cli/command_line.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/sequence.hpp"
#include "host/cli/slurm_jobs.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/engine/share.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/slurm_scripts.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// The shares of a round whose films are not there. Films of another picture in their place are an
/// error now, rather than one of each task.
std::vector<uint32_t> sharesToTake(const PreparedPicture& prepared, const SubmitOptions& options,
                                   const fs::path& folder, uint32_t round = 1) {
    FilmHeader picture = headerOfPicture(*prepared.scene.scene, prepared.picture, options.picture,
                                         {options.scene.source, options.command},
                                         std::string(nameOf(options.device.backend)), "");
    std::vector<uint32_t> missing;
    for (uint32_t share = 1; share <= options.shares; ++share) {
        const fs::path file = folder / filmOfShare(share, options.shares, round);
        if (!fs::exists(file)) {
            missing.push_back(share);
            continue;
        }
        const FilmReader film(file);
        picture.identity.device =
            film.header().identity.device; // that of the nodes, not known here
        const std::string difference = differenceOf(picture, film.header());
        if (!difference.empty())
            throw UsageError(fmt::format("{} {}; remove {}, or give another -o", file.string(),
                                         difference, folder.string()));
    }
    return missing;
}

/// Those that are still to be done: of a round whose plan is there, the missing shares.
std::vector<RoundToSubmit> roundsToSubmit(const PreparedPicture& prepared,
                                          const SubmitOptions& options, const fs::path& folder) {
    std::vector<RoundToSubmit> rounds;
    for (uint32_t round = 2; options.noise > 0 && round <= options.rounds; ++round) {
        RoundToSubmit next{round, fs::exists(folder / planOfRound(round)),
                           sharesToTake(prepared, options, folder, round)};
        if (!next.isPlanned || !next.toTake.empty()) rounds.push_back(std::move(next));
    }
    return rounds;
}

void requireSamples(const RenderSettings& settings, uint32_t shares) {
    const Budget& budget = settings.budget;
    const uint32_t blocks =
        SampleBlocks{budget.mostSamplesPerPixel, budget.samplesPerBlock}.count();
    if (blocks < shares)
        throw UsageError(fmt::format("{} of the {} shares would have no samples: -s makes {} "
                                     "blocks of {}; --block N, of less, makes more",
                                     shares - blocks, shares, blocks,
                                     budget.samplesPerBlock * settings.estimator.branches));
}

/// What the jobs of a picture and those of frames have in common.
SlurmJob jobOf(const SubmitOptions& options, const fs::path& folder) {
    SlurmJob slurm;
    slurm.program = shellQuoted(
        options.program.empty() ? fs::read_symlink("/proc/self/exe").string() : options.program);
    slurm.version = version();
    slurm.picture = shellQuoted(options.output.file);
    slurm.files = shellQuoted(folder);
    slurm.runsIn = shellQuoted(fs::current_path());
    slurm.timeLimit = options.jobTime;
    slurm.sbatch = options.sbatch;
    return slurm;
}

/// The folder of a sequence's scripts: "a.png.frames" of "a.png" and of "a%04d.png", since % means
/// something in the names of Slurm's logs.
fs::path folderOfFrames(const std::string& file) {
    std::string name = fs::path(file).filename().string();
    if (const size_t pattern = name.find('%'); pattern != std::string::npos)
        name.erase(pattern, name.find('d', pattern) + 1 - pattern);
    return fs::path(file).parent_path() / (name + ".frames");
}

/// Parts of a command but for --frames, which each task has of its own.
std::vector<std::string> withoutFrames(std::vector<std::string> parts) {
    std::erase_if(parts, [](const std::string& p) { return p.starts_with("--frames "); });
    return parts;
}

/// A share is of one picture, and blocks and rounds are of shares.
void checkWhatIsSubmitted(DeclaredCommand& c, const SubmitOptions& o) {
    checkFrames(o.sequence, o.scene);
    if (o.shares > 0) {
        const std::string ofPictures =
            c.givenOf({"--background", "--shadow-catcher", "--shadows-on"});
        if (!ofPictures.empty())
            throw UsageError(fmt::format("{}: films of shares have no place for it", ofPictures));
        return;
    }
    if (!o.sequence.isGiven())
        throw UsageError("--shares is required, or --frames or --turntable (see --help)");
    const std::string ofShares = c.givenOf({"--block", "--rounds"});
    if (!ofShares.empty()) throw UsageError(fmt::format("{}: only with --shares", ofShares));
}

void finishSubmit(DeclaredCommand& c, SubmitOptions& o, const Asked& asked) {
    checkWhatIsSubmitted(c, o);
    finishPicture(c, o.picture, asked);
    finishEstimator(c, o, asked);
    finishBudget(o.picture, asked);
    finishSeen(c, o.scene, o.picture);
    if (!asked.cameras.empty())
        throw UsageError("submit is of one picture: --camera names several");
    o.command = c.pictureCommand;
    checkOutputOptions(c, o.output, o.picture);
    o.merge = partsOfPictureFile(o.command);
    for (size_t i = 1; i < o.command.size(); ++i) // the first is the command's name
        if (std::ranges::count(o.merge, o.command[i]) == 0) o.render.push_back(o.command[i]);
    if (!o.output.notes) o.merge.emplace_back("--notes off");
    if (o.shares == 0) { // whole pictures: `render` does what merge would
        o.render.insert(o.render.end(), o.merge.begin(), o.merge.end());
        if (o.noise > 0) o.render.push_back(fmt::format("--noise {}", o.noise));
    }
    o.render = withoutFrames(o.render);
    if (c.has("--device")) o.render.push_back("--device " + shellQuoted(o.device.device));
    if (c.has("-t")) o.render.push_back(fmt::format("-t {}", c.host.threads));
    if (o.device.filmMebibytes)
        o.render.push_back(fmt::format("--film-memory {}", *o.device.filmMebibytes));
    if (o.device.mostMebibytes)
        o.render.push_back(fmt::format("--max-memory {}", *o.device.mostMebibytes));
}

} // namespace

void declareSubmit(DeclaredCommand& c) {
    const auto owned = std::make_shared<SubmitOptions>();
    const auto asked = std::make_shared<Asked>();
    asked->makes = Makes::Pictures;
    asked->maySpread = asked->branchesPay = true;
    asked->even = true; // of shares
    SubmitOptions& submit = *owned;
    c.list.group("Scheduler");
    c.list.choice("SCHEDULER", "", "who gives the work to machines", submit.scheduler)
        .usually("")
        .required()
        .besidePicture();
    c.list
        .number("--shares", "N",
                "tasks: parts of every pixel's samples; of several pictures (--frames, "
                "--turntable) for each",
                submit.shares, {1, 1000})
        .usually("of several pictures: each is rendered whole, by a task of its own")
        .besidePicture();
    declareNoise(c.list,
                 "until the picture's noise is at most T, as of render; shares sample in rounds, "
                 "each where the films until then are noisy, and -s is the number of samples of "
                 "the first one",
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
    declareScene(c.list, submit.scene);
    c.list.group("Output");
    c.list
        .text(
            "-o,--output", "FILE",
            "picture to write, in a folder that all nodes share: .png, .jpg, .webp or .exr; films, "
            "scripts and logs are put into FILE.shares",
            submit.output.file)
        .required()
        .besidePicture()
        .proposes(Proposed::Files);
    declarePictureFile(c.list, submit.output, submit.tone);
    declareSeen(c.list, submit.picture);
    declarePicture(c.list, submit.picture, *asked);
    declareSequence(c.list, submit.sequence);
    declareEstimator(c.list, submit, *asked);
    declareSamples(c.list, submit.picture, *asked,
                   "samples per pixel, the same number for all; with --noise in the first round");
    declareBranches(c.list, submit.picture,
                    "4 where bounces make most of the noise, else 1 (docs/theory/estimator.md)");
    declareClamp(c.list, submit.picture);
    declareBlock(c.list, *asked);
    declareFilmMemory(c.list, submit.device);
    c.list.choice("--backend", "WHICH", "what takes the samples", submit.device.backend);
    declareDevice(c.list, submit.device.device);
    declareHost(c);
    c.finish = [&c, owned, asked] {
        finishSubmit(c, *owned, *asked);
        return *owned;
    };
}

namespace {

/// A picture in shares.
void submitPicture(const PreparedPicture& prepared, const SubmitOptions& options) {
    const auto& [scene, picture] = prepared;
    requireSamples(picture.settings, options.shares);
    const fs::path folder = options.output.file + ".shares";
    SlurmJob slurm = jobOf(options, folder);
    slurm.render = options.render;
    slurm.merge = options.merge;
    slurm.fingerprint = fingerprintOf(*scene.scene, picture.camera);
    slurm.shares = options.shares;
    slurm.toTake = sharesToTake(prepared, options, folder);
    slurm.noise = options.noise;
    const std::vector<RoundToSubmit> rounds = roundsToSubmit(prepared, options, folder);
    nowDoing("submitting");
    if (options.dryRun) return printShares(slurm, rounds);
    checkFileWritable(options.output.file);
    submitShares(slurm, rounds, folder);
}

/// The frames whose pictures are not there, or not finished.
std::vector<uint32_t> framesToRender(const SubmitOptions& options) {
    std::vector<uint32_t> frames = framesOf(options.sequence);
    const size_t all = frames.size();
    std::erase_if(frames, [&](uint32_t frame) {
        const std::string file = fileOfFrame(options.output.file, frame);
        return isFinishedPicture(file, usualCheckpointPath(file).string());
    });
    if (frames.size() < all)
        logging::info(fmt::format("{} of {} pictures are there already", all - frames.size(), all));
    return frames;
}

SubmitOptions submitOptionsOfFrame(const SubmitOptions& asked, uint32_t frame) {
    SubmitOptions one = asked;
    one.output.file = fileOfFrame(asked.output.file, frame);
    takeFrame(one, asked.sequence, frame);
    nameFrame(one.command, frame);
    one.render.push_back(fmt::format("--frames {}", frame));
    return one;
}

/// A task for each frame.
void submitFrames(const SubmitOptions& options, const std::vector<uint32_t>& frames) {
    preparePicture(submitOptionsOfFrame(options, frames.front())); // fails here, not on the nodes
    const fs::path folder = folderOfFrames(options.output.file);
    SlurmJob slurm = jobOf(options, folder);
    slurm.render = options.render;
    slurm.frames = frames;
    nowDoing("submitting");
    if (options.dryRun) return printFrameArrays(slurm);
    checkFileWritable(fileOfFrame(options.output.file, frames.front()));
    submitFrameArrays(slurm, folder);
}

/// Shares of each frame, and their merge.
void submitSharesOfFrames(const SubmitOptions& options, const std::vector<uint32_t>& frames) {
    PreparedPicture prepared;
    for (const uint32_t frame : frames) {
        const SubmitOptions one = submitOptionsOfFrame(options, frame);
        if (!prepared.scene.scene)
            prepared.scene = loadScene(one.scene, toTerminal());
        else if (options.sequence.turntable == 0)
            prepared.scene = loadMoment(one.scene, std::move(prepared.scene), toTerminal());
        prepared.picture = resolvePicture(*prepared.scene.scene, one.picture, toTerminal());
        submitPicture(prepared, one);
    }
}

} // namespace

int submitCommand(const SubmitOptions& options) {
    if (!options.sequence.isGiven()) {
        submitPicture(preparePicture(options), options);
        return 0;
    }
    const std::vector<uint32_t> frames = framesToRender(options);
    if (frames.empty()) return 0;
    if (options.shares == 0)
        submitFrames(options, frames);
    else
        submitSharesOfFrames(options, frames);
    return 0;
}

} // namespace stromboli

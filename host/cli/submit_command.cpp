// `submit`: a picture goes to a scheduler, as shares and their merge.
#include "host/cli/command_line.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/engine/share.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/slurm_scripts.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sys/wait.h>

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

/// A round after the first, as far as it is still to be done.
struct RoundToSubmit {
    uint32_t number = 2;
    bool isPlanned = false; ///< its plan is there
    std::vector<uint32_t> toTake;
};

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

/// Runs sbatch, and returns the number of the job.
std::string sbatch(const std::string& words) {
    const std::string command = "sbatch --parsable " + words;
    FILE* const output = ::popen(command.c_str(), "r");
    std::string said;
    if (output)
        for (int c; (c = std::fgetc(output)) != EOF;)
            said += char(c);
    const int status = output ? ::pclose(output) : -1;
    if (status != 0)
        throw UsageError(fmt::format("'{}' failed{}; --dry-run prints the scripts", command,
                                     WIFEXITED(status) && WEXITSTATUS(status) == 127
                                         ? ": Slurm is not installed here"
                                         : ""));
    return said.substr(0, said.find_first_of(";\n")); // NUMBER, or NUMBER;CLUSTER
}

void writeScript(const fs::path& file, const std::string& text) {
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

/// Jobs that follow each other.
class JobChain {
  public:
    explicit JobChain(fs::path folder) : folder_(std::move(folder)) {}

    /// Submits a script of the folder, to be run when the job before has succeeded. `options` are
    /// of sbatch, `argument` of the script.
    void add(const std::string& script, const std::string& what, const std::string& options = "",
             const std::string& argument = "") {
        const std::string dependency =
            last_.empty()
                ? ""
                : fmt::format("--dependency=afterok:{} --kill-on-invalid-dep=yes ", last_);
        last_ = sbatch(dependency + options + shellQuoted(folder_ / script) + argument);
        logging::info(fmt::format("job {}: {}", last_, what));
    }

  private:
    fs::path folder_;
    std::string last_;
};

void writeScripts(const SlurmJob& job, const fs::path& folder) {
    std::error_code failed;
    fs::create_directory(folder, failed);
    if (failed) failToWrite(folder, failed.message());
    if (!job.toTake.empty()) writeScript(folder / "shares.sh", shareScript(job));
    if (job.isInRounds()) {
        writeScript(folder / "plan.sh", planScript(job));
        writeScript(folder / "round.sh", roundScript(job));
    }
    if (job.isMergedInGroups()) writeScript(folder / "groups.sh", groupScript(job));
    writeScript(folder / "merge.sh", mergeScript(job));
}

void submitToSlurm(const SlurmJob& job, const std::vector<RoundToSubmit>& rounds,
                   const fs::path& folder) {
    writeScripts(job, folder);
    JobChain jobs(folder);
    const auto ofShares = [&](const std::vector<uint32_t>& toTake) {
        return fmt::format("{} of {} shares", toTake.size(), job.shares);
    };
    if (!job.toTake.empty()) jobs.add("shares.sh", ofShares(job.toTake));
    for (const RoundToSubmit& round : rounds) {
        const std::string argument = fmt::format(" {}", round.number);
        if (!round.isPlanned)
            jobs.add("plan.sh", fmt::format("plans round {}", round.number), "", argument);
        jobs.add("round.sh", fmt::format("{} of round {}", ofShares(round.toTake), round.number),
                 fmt::format("--array={} ", arrayOf(round.toTake)), argument);
    }
    if (job.isMergedInGroups())
        jobs.add("groups.sh", fmt::format("merges them in {} groups", job.groups()));
    jobs.add("merge.sh", fmt::format("merges them to {}", job.picture));
}

void printScripts(const SlurmJob& job, const std::vector<RoundToSubmit>& rounds) {
    fmt::print("{}\n", job.toTake.empty() ? "" : shareScript(job));
    if (job.isInRounds()) fmt::print("{}\n{}\n", planScript(job), roundScript(job));
    if (job.isMergedInGroups()) fmt::print("{}\n", groupScript(job));
    fmt::print("{}", mergeScript(job));
    if (!job.isInRounds()) return;
    fmt::print("\n# Each after the one before:\n");
    if (!job.toTake.empty()) fmt::print("# sbatch shares.sh\n");
    for (const RoundToSubmit& round : rounds) {
        if (!round.isPlanned) fmt::print("# sbatch plan.sh {}\n", round.number);
        fmt::print("# sbatch --array={} round.sh {}\n", arrayOf(round.toTake), round.number);
    }
    fmt::print("{}# sbatch merge.sh\n", job.isMergedInGroups() ? "# sbatch groups.sh\n" : "");
}

void finishSubmit(DeclaredCommand& c, SubmitOptions& o, const Asked& asked) {
    finishPicture(c, o.picture, asked);
    finishEstimator(c, o, asked);
    finishBudget(o.picture, asked);
    if (!asked.cameras.empty())
        throw UsageError("submit is of one picture: --camera names several");
    o.picture.estimator.showsBackdrop = !o.picture.transparent;
    o.command = c.pictureCommand;
    checkOutputOptions(c, o.output, o.picture);
    o.merge = partsOfPictureFile(o.command);
    for (size_t i = 1; i < o.command.size(); ++i) // the first is the command's name
        if (std::ranges::count(o.merge, o.command[i]) == 0) o.render.push_back(o.command[i]);
    if (!o.output.notes) o.merge.emplace_back("--notes off");
    if (c.has("--device")) o.render.push_back("--device " + shellQuoted(o.device.device));
    if (c.has("-t")) o.render.push_back(fmt::format("-t {}", c.host.threads));
    if (o.device.filmMebibytes)
        o.render.push_back(fmt::format("--film-memory {}", *o.device.filmMebibytes));
}

} // namespace

void declareSubmit(DeclaredCommand& c) {
    const auto owned = std::make_shared<SubmitOptions>();
    const auto asked = std::make_shared<Asked>();
    asked->makes = Makes::Pictures;
    asked->maySpread = asked->branchesPay = true;
    asked->even = true;
    SubmitOptions& submit = *owned;
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
    declareNoise(c.list,
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
    declareEstimator(c.list, submit, *asked);
    declareSamples(c.list, submit.picture, *asked,
                   "samples per pixel, the same number for all; with --noise in the first round");
    declareBranches(c.list, submit.picture,
                    "4 where bounces make most of the noise, else 1 (docs/theory/estimator.md)");
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

int submitCommand(const SubmitOptions& options) {
    const PreparedPicture prepared = preparePicture(options);
    const auto& [scene, picture] = prepared;
    requireSamples(picture.settings, options.shares);
    const fs::path folder = options.output.file + ".shares";
    SlurmJob slurm;
    slurm.program = shellQuoted(
        options.program.empty() ? fs::read_symlink("/proc/self/exe").string() : options.program);
    slurm.version = version();
    slurm.render = options.render;
    slurm.merge = options.merge;
    slurm.fingerprint = fingerprintOf(*scene.scene, picture.camera);
    slurm.picture = shellQuoted(options.output.file);
    slurm.files = shellQuoted(folder);
    slurm.runsIn = shellQuoted(fs::current_path());
    slurm.shares = options.shares;
    slurm.toTake = sharesToTake(prepared, options, folder);
    slurm.noise = options.noise;
    slurm.timeLimit = options.jobTime;
    slurm.sbatch = options.sbatch;
    const std::vector<RoundToSubmit> rounds = roundsToSubmit(prepared, options, folder);
    nowDoing("submitting");
    if (options.dryRun) {
        printScripts(slurm, rounds);
        return 0;
    }
    checkFileWritable(options.output.file);
    submitToSlurm(slurm, rounds, folder);
    return 0;
}

} // namespace stromboli

// `submit`: a picture goes to a scheduler, as shares and their merge.
#include "host/checkpoint/scene_identity.hpp"
#include "host/cli/activity.hpp"
#include "host/cli/command_line.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/job.hpp"
#include "host/cli/share_render.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/temporary_file.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/slurm_scripts.hpp"
#include "host/version/version.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <sys/wait.h>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// The shares of a round whose films are not there. Films of another picture in their place are an
/// error now, rather than one of each task.
std::vector<uint32_t> sharesToTake(const Job& job, const Options& options, const fs::path& folder,
                                   uint32_t round = 1) {
    FilmHeader picture = headerOfPicture(job, options, "");
    std::vector<uint32_t> missing;
    for (uint32_t share = 1; share <= options.submit.shares; ++share) {
        const fs::path file = folder / filmOfShare(share, options.submit.shares, round);
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
std::vector<RoundToSubmit> roundsToSubmit(const Job& job, const Options& options,
                                          const fs::path& folder) {
    std::vector<RoundToSubmit> rounds;
    for (uint32_t round = 2; options.submit.noise > 0 && round <= options.submit.rounds; ++round) {
        RoundToSubmit next{round, fs::exists(folder / planOfRound(round)),
                           sharesToTake(job, options, folder, round)};
        if (!next.isPlanned || !next.toTake.empty()) rounds.push_back(std::move(next));
    }
    return rounds;
}

void requireSamples(const Job& job, uint32_t shares) {
    const Budget& budget = job.settings.budget;
    const uint32_t blocks =
        SampleBlocks{budget.mostSamplesPerPixel, budget.samplesPerBlock}.count();
    if (blocks < shares)
        throw UsageError(fmt::format("{} of the {} shares would have no samples: -s makes {} "
                                     "blocks of {}; --block N, of less, makes more",
                                     shares - blocks, shares, blocks,
                                     budget.samplesPerBlock * job.settings.estimator.branches));
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

} // namespace

int submitCommand(const Options& options) {
    const Job job = prepareJob(options);
    requireSamples(job, options.submit.shares);
    const fs::path folder = options.output + ".shares";
    SlurmJob slurm;
    slurm.program =
        shellQuoted(options.submit.program.empty() ? fs::read_symlink("/proc/self/exe").string()
                                                   : options.submit.program);
    slurm.version = version();
    slurm.render = options.submit.render;
    slurm.merge = options.submit.merge;
    slurm.fingerprint = fingerprintOf(job);
    slurm.picture = shellQuoted(options.output);
    slurm.files = shellQuoted(folder);
    slurm.runsIn = shellQuoted(fs::current_path());
    slurm.shares = options.submit.shares;
    slurm.toTake = sharesToTake(job, options, folder);
    slurm.noise = options.submit.noise;
    slurm.timeLimit = options.submit.jobTime;
    slurm.sbatch = options.submit.sbatch;
    const std::vector<RoundToSubmit> rounds = roundsToSubmit(job, options, folder);
    nowDoing("submitting");
    if (options.submit.dryRun) {
        printScripts(slurm, rounds);
        return 0;
    }
    checkFileWritable(options.output);
    submitToSlurm(slurm, rounds, folder);
    return 0;
}

} // namespace stromboli

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

/// The shares whose films are not there. Films of another picture in their place are an error now,
/// rather than one of each task.
std::vector<uint32_t> sharesToTake(const Job& job, const Options& options, const fs::path& folder) {
    FilmHeader picture = headerOfPicture(job, options, "");
    std::vector<uint32_t> missing;
    for (uint32_t share = 1; share <= options.submit.shares; ++share) {
        const fs::path file = folder / filmOfShare(share, options.submit.shares);
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

void submitToSlurm(const SlurmJob& job, const fs::path& folder) {
    std::error_code failed;
    fs::create_directory(folder, failed);
    if (failed) failToWrite(folder, failed.message());
    writeScript(folder / "merge.sh", mergeScript(job));
    std::string dependency;
    if (!job.toTake.empty()) {
        writeScript(folder / "shares.sh", shareScript(job));
        const std::string shares = sbatch(shellQuoted(folder / "shares.sh"));
        logging::info(
            fmt::format("job {}: {} of {} shares", shares, job.toTake.size(), job.shares));
        dependency = fmt::format("--dependency=afterok:{} --kill-on-invalid-dep=yes ", shares);
    }
    const std::string merge = sbatch(dependency + shellQuoted(folder / "merge.sh"));
    logging::info(fmt::format("job {}: merges them to {}", merge, job.picture));
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
    slurm.timeLimit = options.submit.jobTime;
    slurm.sbatch = options.submit.sbatch;
    nowDoing("submitting");
    if (options.submit.dryRun) {
        fmt::print("{}\n{}", slurm.toTake.empty() ? "" : shareScript(slurm), mergeScript(slurm));
        return 0;
    }
    checkFileWritable(options.output);
    submitToSlurm(slurm, folder);
    return 0;
}

} // namespace stromboli

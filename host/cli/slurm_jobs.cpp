#include "host/cli/slurm_jobs.hpp"

#include "host/cli/command_line.hpp"
#include "host/cli/log.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <sys/wait.h>
#include <utility>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

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

} // namespace

void submitShares(const SlurmJob& job, const std::vector<RoundToSubmit>& rounds,
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

void printShares(const SlurmJob& job, const std::vector<RoundToSubmit>& rounds) {
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

void submitFrameArrays(const SlurmJob& job, const fs::path& folder) {
    std::error_code failed;
    fs::create_directory(folder, failed);
    if (failed) failToWrite(folder, failed.message());
    writeScript(folder / "frames.sh", frameScript(job));
    for (const FrameArray& array : arraysOf(job.frames)) {
        const std::string number =
            sbatch(fmt::format("--array={} {} {}", arrayOf(array.tasks),
                               shellQuoted(folder / "frames.sh"), array.first));
        logging::info(fmt::format("job {}: {} frames", number, array.tasks.size()));
    }
}

void printFrameArrays(const SlurmJob& job) {
    fmt::print("{}\n# Each by itself:\n", frameScript(job));
    for (const FrameArray& array : arraysOf(job.frames))
        fmt::print("# sbatch --array={} frames.sh {}\n", arrayOf(array.tasks), array.first);
}

} // namespace stromboli

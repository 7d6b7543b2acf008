#include "host/farm/slurm_scripts.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

/// "1-16", "3,7-9": as sbatch's --array has it.
std::string arrayOf(const std::vector<uint32_t>& shares) {
    std::string text;
    for (size_t i = 0; i < shares.size();) {
        size_t end = i + 1;
        while (end < shares.size() && shares[end] == shares[end - 1] + 1)
            ++end;
        if (!text.empty()) text += ",";
        text += end - i == 1 ? std::to_string(shares[i])
                             : fmt::format("{}-{}", shares[i], shares[end - 1]);
        i = end;
    }
    return text;
}

/// The lines at the top that sbatch reads. Slurm starts the tasks of a dead node anew, and what
/// they said before is kept.
std::string directives(const SlurmJob& job, const std::string& name, const std::string& log) {
    std::string text;
    const auto add = [&](const std::string& option) { text += "#SBATCH " + option + "\n"; };
    add("--job-name=" + name);
    add("--chdir=" + job.runsIn);
    add(fmt::format("--output={}/{}.log", job.files, log));
    add("--open-mode=append");
    add("--requeue");
    if (!job.timeLimit.empty()) add("--time=" + job.timeLimit);
    for (const std::string& option : job.sbatch)
        add(option);
    return text;
}

} // namespace

std::string filmOfShare(uint32_t share, uint32_t shares) {
    return fmt::format("part.{}of{}.film", share, shares);
}

std::string shareScript(const SlurmJob& job) {
    return fmt::format("#!/bin/sh\n"
                       "# Takes shares of {picture}. Written by stromboli submit {version}.\n"
                       "{directives}"
                       "#SBATCH --array={array}\n"
                       "\n"
                       "# A film that is there already is kept; one that appears is complete.\n"
                       "share=$SLURM_ARRAY_TASK_ID\n"
                       "{program} render {render} \\\n"
                       "    --share \"$share/{shares}\" --expect {fingerprint} --resume \\\n"
                       "    -o {files}/part.\"$share\"of{shares}.film && exit 0\n"
                       "code=$?\n"
                       "\n"
                       "# A node may be to blame: once more, a few times, where Slurm likes.\n"
                       "test \"${{SLURM_RESTART_COUNT:-0}}\" -lt {retries} &&\n"
                       "    scontrol requeue \"$SLURM_JOB_ID\" && exit 0\n"
                       "exit $code\n",
                       fmt::arg("picture", job.picture), fmt::arg("version", job.version),
                       fmt::arg("directives", directives(job, "stromboli-shares", "share.%a")),
                       fmt::arg("array", arrayOf(job.toTake)), fmt::arg("program", job.program),
                       fmt::arg("render", fmt::join(job.render, " ")),
                       fmt::arg("shares", job.shares), fmt::arg("fingerprint", job.fingerprint),
                       fmt::arg("files", job.files), fmt::arg("retries", kShareRetries));
}

std::string mergeScript(const SlurmJob& job) {
    std::string options;
    for (const std::string& option : job.merge)
        options += " " + option;
    return fmt::format("#!/bin/sh\n"
                       "# Puts the shares of {picture} together. Written by stromboli submit "
                       "{version}.\n"
                       "{directives}"
                       "\n"
                       "{program} merge --complete {files}/part.*of{shares}.film{options} \\\n"
                       "    -o {picture}\n",
                       fmt::arg("picture", job.picture), fmt::arg("version", job.version),
                       fmt::arg("directives", directives(job, "stromboli-merge", "merge")),
                       fmt::arg("program", job.program), fmt::arg("files", job.files),
                       fmt::arg("shares", job.shares), fmt::arg("options", options));
}

} // namespace stromboli

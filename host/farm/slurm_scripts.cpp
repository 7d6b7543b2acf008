#include "host/farm/slurm_scripts.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

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

/// The first lines: what the script does, and for whom.
std::string beginning(const SlurmJob& job, const std::string& what, const std::string& name,
                      const std::string& log) {
    return fmt::format("#!/bin/sh\n# {} Written by stromboli submit {}.\n{}", what, job.version,
                       directives(job, name, log));
}

/// What a script does once its work has failed with $code: back into the queue with the job or, of
/// an array, with this task.
std::string triesAgain() {
    return fmt::format("# A node may be to blame: once more, a few times, where Slurm likes.\n"
                       "test \"${{SLURM_RESTART_COUNT:-0}}\" -lt {} &&\n"
                       "    scontrol requeue \"$SLURM_JOB_ID\" && exit 0\n"
                       "exit $code\n",
                       kJobRetries);
}

/// Renders a share to a film, or goes back into the queue. `plan`: its option, if it has one;
/// `film`: the beginning of the film's name.
std::string takesShare(const SlurmJob& job, const std::string& plan, const std::string& film) {
    return fmt::format("share=$SLURM_ARRAY_TASK_ID\n"
                       "{program} render {render} \\\n"
                       "    {plan}--share \"$share/{shares}\" --expect {fingerprint} --resume \\\n"
                       "    -o {files}/{film}.\"$share\"of{shares}.film && exit 0\n"
                       "code=$?\n"
                       "\n",
                       fmt::arg("program", job.program),
                       fmt::arg("render", fmt::join(job.render, " ")), fmt::arg("plan", plan),
                       fmt::arg("shares", job.shares), fmt::arg("fingerprint", job.fingerprint),
                       fmt::arg("files", job.files), fmt::arg("film", film)) +
           triesAgain();
}

/// A pattern of a shell for the films of a share, or of all ("*"), in all rounds.
std::string filmsOf(const SlurmJob& job, const std::string& share) {
    return fmt::format("{}/{}part.{}of{}.film", job.files, job.isInRounds() ? "*" : "", share,
                       job.shares);
}

} // namespace

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

std::string filmOfShare(uint32_t share, uint32_t shares, uint32_t round) {
    return fmt::format("{}part.{}of{}.film", round > 1 ? fmt::format("round{}.", round) : "", share,
                       shares);
}

std::string planOfRound(uint32_t round) {
    return fmt::format("round{}.plan", round);
}

std::vector<FrameArray> arraysOf(const std::vector<uint32_t>& frames) {
    std::vector<FrameArray> arrays;
    for (const uint32_t frame : frames) {
        const uint32_t first = frame / FrameArray::kMostTasks * FrameArray::kMostTasks;
        if (arrays.empty() || arrays.back().first != first) arrays.push_back({first, {}});
        arrays.back().tasks.push_back(frame - first);
    }
    return arrays;
}

std::string frameScript(const SlurmJob& job) {
    return beginning(job,
                     fmt::format("Renders frames of {}: frames.sh FIRST, to which the number of "
                                 "the task is added.",
                                 job.picture),
                     "stromboli-frames", "frame.%A_%a") +
           fmt::format(
               "\n"
               "# A frame that is there already is kept, and one whose node has died goes on\n"
               "# from its checkpoint.\n"
               "frame=$(($1 + SLURM_ARRAY_TASK_ID))\n"
               "{} render {} \\\n"
               "    --frames \"$frame\" --resume -o {} && exit 0\n"
               "code=$?\n"
               "\n",
               job.program, fmt::join(job.render, " "), job.picture) +
           triesAgain();
}

std::string shareScript(const SlurmJob& job) {
    return beginning(job, fmt::format("Takes shares of {}.", job.picture), "stromboli-shares",
                     "share.%a") +
           fmt::format("#SBATCH --array={}\n"
                       "\n"
                       "# A film that is there already is kept; one that appears is complete.\n",
                       arrayOf(job.toTake)) +
           takesShare(job, "", "part");
}

std::string planScript(const SlurmJob& job) {
    return beginning(job,
                     fmt::format("Plans a round of {}: plan.sh ROUND, from 2 on.", job.picture),
                     "stromboli-plan", "plan") +
           fmt::format(
               "\n"
               "# A plan that is there already is kept, because films follow it. Where there is\n"
               "# none of the round before, nothing was left to do.\n"
               "round=$1\n"
               "test -e {files}/round\"$round\".plan && exit 0\n"
               "test \"$round\" -eq 2 || test -e {files}/round$((round - 1)).plan || exit 0\n"
               "{program} plan --noise {noise} {films} \\\n"
               "    -o {files}/round\"$round\".plan\n"
               "code=$?\n"
               "test $code -eq 0 || test $code -eq 7 && exit 0 # 7: nothing is left to do\n"
               "\n",
               fmt::arg("files", job.files), fmt::arg("program", job.program),
               fmt::arg("noise", job.noise), fmt::arg("films", filmsOf(job, "*"))) +
           triesAgain();
}

std::string roundScript(const SlurmJob& job) {
    return beginning(job,
                     fmt::format("Takes shares of a round of {}: round.sh ROUND, from 2 on.",
                                 job.picture),
                     "stromboli-round", "share.%a") +
           fmt::format("\n"
                       "# Without a plan nothing was left to do.\n"
                       "plan={}/round\"$1\".plan\n"
                       "test -e \"$plan\" || exit 0\n",
                       job.files) +
           takesShare(job, "--plan \"$plan\" ", "round\"$1\".part");
}

std::string groupScript(const SlurmJob& job) {
    return beginning(job, fmt::format("Puts groups of shares of {} together.", job.picture),
                     "stromboli-groups", "group.%a") +
           fmt::format("#SBATCH --array=1-{groups}\n"
                       "\n"
                       "group=$SLURM_ARRAY_TASK_ID\n"
                       "share=$(((group - 1) * {size}))\n"
                       "set --\n"
                       "while test $share -lt {shares} && test $share -lt $((group * {size})); do\n"
                       "    share=$((share + 1))\n"
                       "    set -- \"$@\" {films}\n"
                       "done\n"
                       "{program} merge \"$@\" \\\n"
                       "    -o {files}/group.\"$group\"of{groups}.film && exit 0\n"
                       "code=$?\n"
                       "\n",
                       fmt::arg("groups", job.groups()), fmt::arg("size", SlurmJob::kGroup),
                       fmt::arg("shares", job.shares),
                       fmt::arg("films", filmsOf(job, "\"$share\"")),
                       fmt::arg("program", job.program), fmt::arg("files", job.files)) +
           triesAgain();
}

std::string mergeScript(const SlurmJob& job) {
    std::string options;
    for (const std::string& option : job.merge)
        options += " " + option;
    const std::string films = job.isMergedInGroups()
                                  ? fmt::format("{}/group.*of{}.film", job.files, job.groups())
                                  : filmsOf(job, "*");
    return beginning(job, fmt::format("Puts the shares of {} together.", job.picture),
                     "stromboli-merge", "merge") +
           fmt::format("\n{} merge --complete {}{} \\\n    -o {} && exit 0\ncode=$?\n\n",
                       job.program, films, options, job.picture) +
           triesAgain();
}

} // namespace stromboli

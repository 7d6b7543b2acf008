#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace stromboli {

/// A picture that a cluster with Slurm renders. Words of commands are quoted for a shell; files are
/// named from the folder that the jobs run in.
struct SlurmJob {
    std::string program; ///< as the nodes find it
    std::string version; ///< of the program that submits
    std::vector<std::string>
        render;                     ///< SCENE and the options of `render`, without output and share
    std::vector<std::string> merge; ///< the options of `merge`, without output
    std::string fingerprint;        ///< for --expect
    std::string picture;
    std::string files;  ///< the folder of the films, plans, scripts and logs
    std::string runsIn; ///< a folder that all nodes share
    /// Frames that are rendered whole, a task each; the picture's name is a pattern or gets their
    /// numbers. None: the picture is rendered in shares.
    std::vector<uint32_t> frames;
    uint32_t shares = 1;
    std::vector<uint32_t> toTake;    ///< the shares of the first round whose films are not there
    double noise = 0;                ///< to be reached in rounds; 0: there is one round
    std::string timeLimit;           ///< of each job; empty: the cluster's own
    std::vector<std::string> sbatch; ///< more options of sbatch

    bool isInRounds() const { return noise > 0; }
    /// Films are merged in groups of this many shares first, and then the groups, where one machine
    /// would read for long.
    bool isMergedInGroups() const { return shares > kMergedAtOnce; }
    uint32_t groups() const { return (shares + kGroup - 1) / kGroup; }
    static constexpr uint32_t kMergedAtOnce = 64, kGroup = 32;
};

/// A failing job is tried so many times more, on whatever node Slurm chooses.
inline constexpr uint32_t kJobRetries = 3;

/// The names that the scripts give the film of a share of a round, and the plan of a round from the
/// second on. Both are in the folder of the job's files.
std::string filmOfShare(uint32_t share, uint32_t shares, uint32_t round = 1);
std::string planOfRound(uint32_t round);

/// "1-16", "3,7-9": as sbatch's --array has it.
std::string arrayOf(const std::vector<uint32_t>& shares);

/// Frames that are to be rendered by one job array, whose tasks count from `first` on.
struct FrameArray {
    uint32_t first = 0;
    std::vector<uint32_t> tasks;
    static constexpr uint32_t kMostTasks = 1000; ///< Slurm's own limit is 1001, if no other is set
};
/// frames: in rising order.
std::vector<FrameArray> arraysOf(const std::vector<uint32_t>& frames);

/// A batch script that renders frames: the one that its argument and the number of the task add up
/// to.
std::string frameScript(const SlurmJob& job);

/// A batch script that takes all shares of the first round that are to be taken, as a job array.
std::string shareScript(const SlurmJob& job);
/// One that plans a round, whose number is its argument, once all films of those before are there.
std::string planScript(const SlurmJob& job);
/// One that takes shares of a round, whose number is its argument; sbatch is told which. Where
/// there is no plan, nothing is left to do.
std::string roundScript(const SlurmJob& job);
/// One that puts the films of a group of shares together, as a job array.
std::string groupScript(const SlurmJob& job);
/// One that puts the films, or those of groups, together, once all are there.
std::string mergeScript(const SlurmJob& job);

} // namespace stromboli

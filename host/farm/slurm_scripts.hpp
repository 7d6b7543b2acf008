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
    std::string files;  ///< the folder of the films, scripts and logs
    std::string runsIn; ///< a folder that all nodes share
    uint32_t shares = 1;
    std::vector<uint32_t> toTake;    ///< the shares whose films are not there yet
    std::string timeLimit;           ///< of each job; empty: the cluster's own
    std::vector<std::string> sbatch; ///< more options of sbatch
};

/// A failing share is tried so many times more, on whatever node Slurm chooses.
inline constexpr uint32_t kShareRetries = 3;

/// As the script names the film of a share: it is in the folder of the job's files.
std::string filmOfShare(uint32_t share, uint32_t shares);

/// A batch script that takes all shares that are to be taken, as a job array.
std::string shareScript(const SlurmJob& job);
/// A batch script that puts the films together, once all are there.
std::string mergeScript(const SlurmJob& job);

} // namespace stromboli

#pragma once

#include "host/farm/slurm_scripts.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace stromboli {

// Scripts are written into `folder` and given to sbatch, or printed with what sbatch would be
// called with. Submitting throws OutputError, and UsageError if sbatch fails.

/// A round after the first, as far as it is still to be done.
struct RoundToSubmit {
    uint32_t number = 2;
    bool isPlanned = false; ///< its plan is there
    std::vector<uint32_t> toTake;
};

void submitShares(const SlurmJob& job, const std::vector<RoundToSubmit>& rounds,
                  const std::filesystem::path& folder);
void printShares(const SlurmJob& job, const std::vector<RoundToSubmit>& rounds);

/// SlurmJob::frames, a task for each.
void submitFrameArrays(const SlurmJob& job, const std::filesystem::path& folder);
void printFrameArrays(const SlurmJob& job);

} // namespace stromboli

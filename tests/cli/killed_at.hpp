#pragma once

#include "tests/cli/program.hpp"

#include <cstdint>
#include <string>

namespace stromboli::test {

/// Environment of a program that is killed (exit code 137) at the n-th time that it writes to a
/// file of the folder, forces one to the disk, or is about to rename one or has done so
/// (killed_at.cpp). It ends by itself where it does so fewer times. Without the validation layer.
inline std::string killedAt(const ScratchFolder& folder, uint32_t n) {
    return "STROMBOLI_VALIDATION=0 LD_PRELOAD=" STROMBOLI_KILLED_AT " STROMBOLI_KILL_FOLDER=" +
           folder.path().string() + " STROMBOLI_KILL_AT=" + std::to_string(n);
}
inline constexpr int kWasKilled = 128 + 9;

} // namespace stromboli::test

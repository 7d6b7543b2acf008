#pragma once

#include "host/core/error.hpp"

namespace stromboli {

/// Exit codes of the program; the numbers are part of its interface (README, "Exit codes"). 5 is
/// that of the `stromboli` script where it cannot build the program.
enum class ExitCode : int {
    Success = 0,
    Usage = 1,
    Scene = 2,
    Device = 3,
    Output = 4,
    Undecided = 6,
    NothingLeft = 7
};

/// What the program ends with after an error.
inline ExitCode exitCodeOf(ErrorKind kind) {
    switch (kind) {
    case ErrorKind::Usage:
        return ExitCode::Usage;
    case ErrorKind::Scene:
        return ExitCode::Scene;
    case ErrorKind::Device:
    case ErrorKind::DeviceLost:
        return ExitCode::Device;
    case ErrorKind::Output:
        return ExitCode::Output;
    }
    return ExitCode::Device;
}

} // namespace stromboli

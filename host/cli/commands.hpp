#pragma once

#include "host/cli/options.hpp"
#include "host/core/error.hpp"

namespace stromboli {

// --- Commands ------------------------------------------------------------------------------------

/// Each runs one command and returns the program's exit code; errors are thrown.
int renderCommand(const RenderOptions& options);
int checkCommand(const CheckOptions& options);
int infoCommand(const InfoOptions& options);
int kernelsCommand(const KernelsOptions& options);
int devicesCommand(const DevicesOptions& options);
int benchCommand(const BenchOptions& options);
int compareCommand(const CompareOptions& options);
int mergeCommand(const MergeOptions& options);
int planCommand(const PlanOptions& options);
int submitCommand(const SubmitOptions& options);
int studyCommand(const StudyOptions& options);
int stressCommand(const StressOptions& options);
int regressCommand(const RegressOptions& options);
int tonemapCommand(const TonemapOptions& options);
int denoiseCommand(const DenoiseOptions& options);
int viewCommand(const ViewOptions& options);

/// A scene that is loaded, and the picture of it that is asked for. Warns of what makes the picture
/// black.
struct PreparedPicture {
    LoadedScene scene;
    ResolvedPicture picture;
};
PreparedPicture preparePicture(const SceneAndPicture& work);

// --- Exit codes ----------------------------------------------------------------------------------

/// Exit codes of the program; the numbers are part of its interface (README, "Exit codes"). 5 is
/// that of the `stromboli` script where it cannot build the program.
enum class ExitCode : int {
    Success = 0,
    Usage = 1,
    Scene = 2,
    Device = 3,
    Output = 4,
    TooFewSamples = 6, ///< to decide, or than films should have that were merged
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

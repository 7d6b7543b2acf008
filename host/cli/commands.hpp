#pragma once

#include "host/cli/options.hpp"

namespace stromboli {

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

/// A scene that is loaded, and the picture of it that is asked for. Warns of what makes the picture
/// black.
struct PreparedPicture {
    LoadedScene scene;
    ResolvedPicture picture;
};
PreparedPicture preparePicture(const SceneAndPicture& work);

} // namespace stromboli

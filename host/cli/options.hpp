#pragma once

#include "host/cli/bench_options.hpp"
#include "host/cli/compare_options.hpp"
#include "host/cli/stress_options.hpp"
#include "host/cli/study_options.hpp"
#include "host/core/log.hpp"
#include "host/core/named_values.hpp"
#include "host/farm/film_header.hpp"
#include "host/film/tone.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/layers.hpp"
#include "host/render/settings.hpp"
#include "scene/add_environment.hpp"
#include "scene/build/conventions.hpp"
#include "scene/camera/camera.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

enum class Command {
    Render,
    Check,
    Info,
    Kernels,
    Devices,
    Bench,
    Stress,
    Compare,
    Study,
    Merge,
    Plan,
    Submit
};
/// Rather than look at one, or measure.
inline bool rendersPictures(Command command) {
    return command == Command::Render || command == Command::Submit;
}
enum class Scheduler { Slurm };
template <>
inline constexpr auto kNamedValues<Scheduler> = std::to_array<NamedValue<Scheduler>>({
    {Scheduler::Slurm, "slurm", "job arrays, and a job that merges"},
});
enum class BackendChoice { Vulkan, Reference };
template <>
inline constexpr auto kNamedValues<BackendChoice> = std::to_array<NamedValue<BackendChoice>>({
    {BackendChoice::Vulkan, "vulkan", "the kernel, on a Vulkan device"},
    {BackendChoice::Reference, "reference", "the slow double-precision path tracer on the CPU"},
});

template <>
inline constexpr auto kNamedValues<PathScheduler> = std::to_array<NamedValue<PathScheduler>>({
    {PathScheduler::Persistent, "persistent", "one kernel, whose lanes follow paths"},
    {PathScheduler::Wavefront, "wavefront", "kernels that draw, trace and follow, with queues"},
});
template <>
inline constexpr auto kNamedValues<CameraChoice> = std::to_array<NamedValue<CameraChoice>>({
    {CameraChoice::Automatic, "auto",
     "frame for the CS184 dialect and for files without a camera, else file"},
    {CameraChoice::File, "file", "the file's camera, of several the first (--cs184: the last)"},
    {CameraChoice::Frame, "frame", "all of the scene, as the CS184 renderer frames it"},
});

/// Names one sample of a picture: column, row from the top, number.
struct SampleName {
    uint32_t x = 0, y = 0, sample = 0;
};

struct FrameRange {
    uint32_t first = 0, last = 0; ///< both belong to it
};

/// Pictures with numbers, which make a film.
struct SequenceOptions {
    uint32_t turntable = 0; ///< pictures of a whole turn about the scene; 0: of an animation
    std::optional<FrameRange> frames;
    double framesPerSecond = 24; ///< of an animation

    bool isGiven() const { return turntable > 0 || frames; }
};

/// `submit`, beside the picture.
struct SubmitOptions {
    Scheduler scheduler = Scheduler::Slurm;
    uint32_t shares = 0;
    double noise = 0;    ///< to be reached in rounds; 0: one round
    uint32_t rounds = 8; ///< at most
    /// Of the commands that the nodes run, quoted for a shell.
    std::vector<std::string> render, merge;
    std::string program; ///< as the nodes find it; empty: where this one is
    std::string jobTime;
    std::vector<std::string> sbatch; ///< options of it
    bool dryRun = false;
};

/// The command line, understood and checked; what needs the scene (picture size) is still open.
struct Options {
    Command command = Command::Render;
    std::string scene;
    std::string output;
    PictureArea area;
    bool sizeGiven = false;                         ///< area.width, height
    bool bouncesGiven = false, filterGiven = false; ///< estimator.maxBounces, filter
    bool integratorGiven = false;                   ///< estimator.integrator
    SceneConventions reading;                       ///< of the scene's file
    EnvironmentRequest environment;
    FramingConventions framing;
    Estimator estimator;              ///< its branches are not yet chosen
    std::optional<uint32_t> branches; ///< empty: what pays in the scene
    PathBudget budget;
    CameraRequest camera;
    /// A picture of each of these cameras of the file (names, numbers; "all" alone: of each);
    /// empty: one, of `camera`.
    std::vector<std::string> cameras;
    SequenceOptions sequence;
    std::string device;
    PathScheduler scheduler = PathScheduler::Persistent;
    std::string deviceFamily; ///< of AMD GPUs, of `kernels`: compile for it; empty: for the device
    BackendChoice backend = BackendChoice::Vulkan;
    ToneCurve tone;
    std::string statsFile;
    std::string checkpointFile;            ///< empty: the usual one; "off": none
    double checkpointSeconds = 60;         ///< from one to the next
    bool resume = false;                   ///< goes on from the checkpoint
    std::optional<uint32_t> filmMebibytes; ///< for the film; empty: half of the machine's memory
    /// The command without what leaves the picture as it is: its own name, the device, checkpoints.
    /// Words that belong together are one of its parts.
    std::vector<std::string> pictureCommand;
    bool notes = true;               ///< of the picture, in its file
    bool statisticsChannels = false; ///< EXR: sample counts and variances
    bool transparent = false;        ///< alpha in place of the environment
    std::vector<Layer> layers;       ///< EXR: channels beside the radiance
    std::optional<ShareName> share;  ///< take only these samples, into a film
    std::string planFile;            ///< render: of this round; empty: of the first
    /// The fingerprint that scene and program must have (host/cli/share_render.hpp); empty: any.
    std::string expected;
    std::optional<SampleName> sampleAlone; ///< print this sample and write nothing
    uint32_t threads = 0;                  ///< host threads; 0: all
    Verbosity verbosity = Verbosity::Normal;
    std::vector<std::string> remarks; ///< on what was given and has no effect
    double familyWiseError = 0.01;    ///< check
    BenchOptions bench;
    CompareOptions compare;
    StudyOptions study;
    StressOptions stress;
    std::string infoJsonFile; ///< info; empty: text
    SubmitOptions submit;
    std::vector<std::string> films; ///< merge, plan
    bool wantsAllShares = false;    ///< merge: without all of them there is no picture
};

/// Parses the arguments (without the program's name). Empty: help or version was printed and the
/// program is done. Throws UsageError.
std::optional<Options> parseOptions(std::vector<std::string> arguments);

} // namespace stromboli

#pragma once

#include "host/bench/bench.hpp"
#include "host/cli/log.hpp"
#include "host/compare/comparison.hpp"
#include "host/core/text.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_request.hpp"
#include "host/engine/render_result.hpp"
#include "host/farm/film_header.hpp"
#include "host/film/image_file.hpp"
#include "host/study/study.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace stromboli {

// What each command was asked to do, understood and checked. What needs the scene is still open.

template <>
inline constexpr auto kNamedValues<CameraChoice> = std::to_array<NamedValue<CameraChoice>>({
    {CameraChoice::Automatic, "auto",
     "frame for the dialect CGL and for files without a camera, else file"},
    {CameraChoice::File, "file", "the file's camera, of several the first"},
    {CameraChoice::Frame, "frame", "all of the scene"},
});

/// What every command is told.
struct HostOptions {
    uint32_t threads = 0; ///< 0: all
    Verbosity verbosity = Verbosity::Normal;
    std::vector<std::string> remarks; ///< on what was given and has no effect
    std::string presetSets;           ///< a line on what a preset sets; empty: there is none
};

/// What commands about a picture of a scene have in common.
struct SceneAndPicture {
    SceneRequest scene;
    RenderRequest picture;
    DeviceRequest device;
    ToneMapping tone;
};

/// The file of a picture.
struct OutputOptions {
    std::string file;
    PictureEncoding encoding;
    bool notes = true;               ///< of the picture, in its file
    bool statisticsChannels = false; ///< EXR: sample counts and variances
    std::string statsFile;           ///< empty: none
};

struct CheckpointOptions {
    std::string file; ///< empty: the usual one; "off": none
    double everySeconds = 60;
    bool resume = false; ///< goes on from the checkpoint
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

struct ShareOptions {
    std::optional<ShareName> share; ///< take only these samples, into a film
    std::string planFile;           ///< of this round; empty: of the first
    /// The fingerprint that scene and program must have (host/engine/share.hpp); empty: any.
    std::string expected;
};

/// Who is shown the picture while it is rendered.
struct WatchOptions {
    std::optional<uint32_t> port; ///< of a page; 0: any that is free
    std::string updateFile;       ///< empty: none
    double updateSeconds = 5;     ///< from one writing to the next
    std::string tev;              ///< HOST:PORT; empty: none

    bool isGiven() const { return port || !updateFile.empty() || !tev.empty(); }
};

/// How it is said how far a render is.
enum class ProgressForm {
    Auto,    ///< a bar in the status line; where there is none, lines
    Lines,   ///< messages
    Objects, ///< one JSON object a line, on standard error
    Off
};

struct ProgressRequest {
    ProgressForm form = ProgressForm::Auto;
    double everySeconds = 10; ///< from one line to the next
};

/// What is to be told of one pixel in place of a picture.
struct PixelQuestion {
    uint32_t x = 0, y = 0;          ///< column, row from the top
    std::optional<uint32_t> sample; ///< one of them; empty: all together
    std::string jsonFile;           ///< empty: text
};

struct RenderOptions : SceneAndPicture {
    OutputOptions output;
    WatchOptions watch;
    ProgressRequest progress;
    /// A picture of each of these cameras of the file (names, numbers; "all" alone: of each);
    /// empty: one, of picture.camera.
    std::vector<std::string> cameras;
    SequenceOptions sequence;
    CheckpointOptions checkpoint;
    bool skipExisting = false; ///< pictures that are finished are not rendered again
    ShareOptions share;
    std::optional<PixelQuestion> pixelAlone; ///< explain this pixel and make no picture
    /// The command without what leaves the picture as it is: its own name, the device, checkpoints.
    /// Words that belong together are one of its parts.
    std::vector<std::string> command;
};

struct CheckOptions : SceneAndPicture {
    std::vector<std::string> scenes; ///< instead of SceneRequest::source
    std::string jsonFile;            ///< empty: none
    double familyWiseError = 0.01;
};

struct InfoOptions : SceneAndPicture {
    std::string jsonFile; ///< empty: text
};

struct KernelsOptions : SceneAndPicture {
    std::vector<std::string> scenes; ///< instead of SceneRequest::source
    std::string deviceFamily;        ///< of AMD GPUs: compile for it; empty: for the device
};

struct DevicesOptions {
    std::string device;
};

struct BenchOptions {
    bench::BenchSettings settings;
    std::string jsonFile;      ///< empty: none
    bool probeStartup = false; ///< time the stages of this process's start, and no more
};

struct StressOptions {
    std::vector<std::string> cases; ///< names, or numbers of docs/hard_cases.md; empty: all
    bool list = false, full = false;
    std::string jsonFile; ///< empty: none
    std::string device;
};

struct RegressOptions {
    std::string suite;
    std::vector<std::string> only; ///< names of pictures; empty: all
    bool update = false;
    std::string folder = "regress";
    DeviceRequest device;
    Verbosity verbosity = Verbosity::Normal;
};

/// What a PNG of the difference shows.
enum class DifferenceView { Flip, Relative, Signed };
template <>
inline constexpr auto kNamedValues<DifferenceView> = std::to_array<NamedValue<DifferenceView>>({
    {DifferenceView::Flip, "flip", "FLIP, black 0 to white 1"},
    {DifferenceView::Relative, "relative", "the error that relMSE squares, black 0 to white 1"},
    {DifferenceView::Signed, "signed", "blue where IMG is darker, red where it is brighter"},
});

struct CompareOptions {
    std::string reference, picture;
    compare::CompareSettings settings;
    compare::Thresholds thresholds;
    std::string jsonFile;       ///< empty: none; "-": standard output, instead of the text
    std::string differenceFile; ///< empty: none
    DifferenceView show = DifferenceView::Flip;
    std::string varianceFile;        ///< of one sample of the reference; empty: none
    std::optional<uint32_t> samples; ///< of each pixel of the picture, for varianceFile
    double referenceSamples = compare::kReferenceSamples; ///< of each pixel, for varianceFile
    bool familyErrorGiven = false;                        ///< on the command line
};

struct StudyOptions {
    study::StudySettings settings;
    std::string folder = "study";
    bool list = false; ///< print the known configurations and no more
    std::string device;
    Verbosity verbosity = Verbosity::Normal;
};

struct MergeOptions {
    std::vector<std::string> films;
    bool wantsAllShares = false; ///< without all of them there is no picture
    OutputOptions output;
    ToneMapping tone;
    /// The options of `render` that are given when films become a picture.
    std::vector<std::string> ofPicture;
};

struct TonemapOptions {
    std::string picture;
    std::string layer; ///< empty: the picture itself
    OutputOptions output;
    ToneMapping tone;
    std::vector<std::string> command; ///< as RenderOptions::command
};

struct DenoiseOptions {
    std::string picture;
    Denoiser denoiser = Denoiser::On;
    OutputOptions output;
    ToneMapping tone;
    std::string device;
    std::vector<std::string> command; ///< as RenderOptions::command
};

struct ViewOptions : SceneAndPicture {
    std::string host = "127.0.0.1"; ///< the address to listen at
    uint32_t port = 0;              ///< 0: any that is free
    bool open = false;              ///< a browser
    // What the page begins with.
    View viewTransform = View::Standard;
    std::string exposure = "auto"; ///< a number, or auto
    bool denoised = false;
    std::string reference; ///< a picture to compare with; empty: none
    /// The parts of a command that renders what is viewed, apart from camera, size and tone.
    std::vector<std::string> command;
    /// Those that say what camera is taken, as long as nobody has moved it.
    std::vector<std::string> cameraWords;
};

struct PlanOptions {
    std::vector<std::string> films;
    std::string file;
    double noise = 0;                  ///< to be reached
    std::optional<uint32_t> mostPaths; ///< of a pixel, over all rounds; empty: no limit
};

enum class Scheduler { Slurm };
template <>
inline constexpr auto kNamedValues<Scheduler> = std::to_array<NamedValue<Scheduler>>({
    {Scheduler::Slurm, "slurm", "job arrays, and a job that merges"},
});

struct SubmitOptions : SceneAndPicture {
    OutputOptions output;
    Scheduler scheduler = Scheduler::Slurm;
    uint32_t shares = 0;      ///< 0: frames are rendered whole
    SequenceOptions sequence; ///< a picture of each frame
    double noise = 0;         ///< to be reached, of shares in rounds; 0: no such end
    uint32_t rounds = 8;      ///< at most
    /// Options of the commands that the nodes run, quoted for a shell.
    std::vector<std::string> render, merge;
    std::string program; ///< as the nodes find it; empty: where this one is
    std::string jobTime;
    std::vector<std::string> sbatch; ///< options of it
    bool dryRun = false;
    std::vector<std::string> command; ///< as RenderOptions::command
};

using CommandOptions = std::variant<RenderOptions, CheckOptions, InfoOptions, KernelsOptions,
                                    DevicesOptions, BenchOptions, StressOptions, RegressOptions,
                                    CompareOptions, StudyOptions, MergeOptions, PlanOptions,
                                    SubmitOptions, TonemapOptions, DenoiseOptions, ViewOptions>;

/// The command line, understood and checked.
struct ParsedCommand {
    HostOptions host;
    CommandOptions options;
};

/// Parses the arguments (without the program's name). Empty: help or version was printed and the
/// program is done. Throws UsageError.
std::optional<ParsedCommand> parseOptions(std::vector<std::string> arguments);

} // namespace stromboli

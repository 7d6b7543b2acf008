#include "host/cli/command_line.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/log.hpp"
#include "host/cli/options.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/process/process.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace {

using namespace stromboli;

/// The function of each command.
struct Run {
    int operator()(const RenderOptions& o) const { return renderCommand(o); }
    int operator()(const CheckOptions& o) const { return checkCommand(o); }
    int operator()(const InfoOptions& o) const { return infoCommand(o); }
    int operator()(const KernelsOptions& o) const { return kernelsCommand(o); }
    int operator()(const DevicesOptions& o) const { return devicesCommand(o); }
    int operator()(const BenchOptions& o) const { return benchCommand(o); }
    int operator()(const StressOptions& o) const { return stressCommand(o); }
    int operator()(const RegressOptions& o) const { return regressCommand(o); }
    int operator()(const CompareOptions& o) const { return compareCommand(o); }
    int operator()(const StudyOptions& o) const { return studyCommand(o); }
    int operator()(const MergeOptions& o) const { return mergeCommand(o); }
    int operator()(const PlanOptions& o) const { return planCommand(o); }
    int operator()(const SubmitOptions& o) const { return submitCommand(o); }
    int operator()(const TonemapOptions& o) const { return tonemapCommand(o); }
    int operator()(const DenoiseOptions& o) const { return denoiseCommand(o); }
    int operator()(const ViewOptions& o) const { return viewCommand(o); }
};

int run(const ParsedCommand& command) {
    const uint32_t threads = command.host.threads;
    const tbb::global_control most(tbb::global_control::max_allowed_parallelism,
                                   threads ? threads
                                           : std::max(1u, std::thread::hardware_concurrency()));
    return std::visit(Run{}, command.options);
}

int runLine(const std::vector<std::string>& arguments) {
    if (arguments.empty()) {
        fmt::print(stderr, "{}", shortHelp());
        return int(ExitCode::Usage); // nothing was done, as scripts should notice
    }
    const std::optional<ParsedCommand> command = parseOptions(arguments);
    if (!command) return 0;
    const HostOptions& host = command->host;
    setUpLogging(host.verbosity, status_line::clear);
    status_line::allow(host.verbosity != Verbosity::Quiet);
    // lavapipe asks for it when the device is opened: all contestants get as many threads.
    if (std::holds_alternative<BenchOptions>(command->options) && host.threads > 0)
        process::useDriverThreads(host.threads);
    watchSignals();
    for (const std::string& remark : host.remarks)
        logging::warn(remark);
    if (!host.presetSets.empty()) logging::info(host.presetSets);
    return run(*command);
}

/// Nothing else is drawn from here on, and no line stays behind.
int fail(const char* message, ExitCode code) {
    nowDoing("ending", StatusLine::OfOthers);
    logging::error(message);
    return int(code);
}

/// What is printed must have been written, too.
int finished(int code) try {
    nowDoing("ending", StatusLine::OfOthers);
    finishStandardOutput();
    return code;
} catch (const Error& error) {
    return fail(error.what(), exitCodeOf(error.kind()));
}

} // namespace

int main(int argc, char** argv) {
    reserveStandardStreams();
    setUpLogging(Verbosity::Normal, status_line::clear);
    process::useMemoryInLargePieces();
    process::useWideVectors();
    process::leaveOutDriversOfAbsentGpus();
    try {
        return finished(runLine({argv + 1, argv + argc}));
    } catch (const Error& error) {
        return fail(error.what(), exitCodeOf(error.kind()));
    } catch (const std::bad_alloc&) {
        return fail("out of memory", ExitCode::Scene);
    } catch (const std::exception& error) {
        if (std::ferror(stdout)) return finished(int(ExitCode::Output)); // fmt could not print
        return fail(error.what(), ExitCode::Device);
    }
}

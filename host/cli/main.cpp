#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/options.hpp"
#include "host/cli/short_help.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/output.hpp"
#include "host/core/status_line.hpp"
#include "host/vulkan/vector_width.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <thread>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

int run(const stromboli::Options& options) {
    using stromboli::Command;
    const tbb::global_control threads(
        tbb::global_control::max_allowed_parallelism,
        options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency()));
    switch (options.command) {
    case Command::Render:
        return options.sampleAlone ? stromboli::sampleCommand(options)
                                   : stromboli::renderCommand(options);
    case Command::Check:
        return stromboli::checkCommand(options);
    case Command::Info:
        return stromboli::infoCommand(options);
    case Command::Kernels:
        return stromboli::kernelsCommand(options);
    case Command::Devices:
        return stromboli::devicesCommand(options);
    case Command::Bench:
        return stromboli::benchCommand(options);
    case Command::Compare:
        return stromboli::compareCommand(options);
    case Command::Merge:
        return stromboli::mergeCommand(options);
    case Command::Plan:
        return stromboli::planCommand(options);
    case Command::Submit:
        return stromboli::submitCommand(options);
    case Command::Study:
        return stromboli::studyCommand(options);
    case Command::Stress:
        return stromboli::stressCommand(options);
    }
    return 0;
}

/// Of what is freed some is kept for what is asked for next: between two passes the plan takes and
/// frees many times the picture, and to have its pages zeroed anew each time is 5 % of a render's
/// CPU time.
void keepFreedMemory() {
#ifdef __GLIBC__
    constexpr int kKept = 256 << 20; // bytes: the plan of a picture of two million pixels
    mallopt(M_TRIM_THRESHOLD, kKept);
    mallopt(M_MMAP_THRESHOLD, kKept);
#endif
}

int runLine(const std::vector<std::string>& arguments) {
    if (arguments.empty()) {
        fmt::print(stderr, "{}", stromboli::shortHelp());
        return int(stromboli::ExitCode::Usage); // nothing was done, as scripts should notice
    }
    const auto options = stromboli::parseOptions(arguments);
    if (!options) return 0;
    stromboli::setUpLogging(options->verbosity);
    stromboli::status_line::allow(options->verbosity != stromboli::Verbosity::Quiet);
    stromboli::watchSignals();
    for (const std::string& remark : options->remarks)
        stromboli::logging::warn(remark);
    return run(*options);
}

/// Nothing else is drawn from here on, and no line stays behind.
int fail(const char* message, stromboli::ExitCode code) {
    stromboli::nowDoing("ending", stromboli::StatusLine::OfOthers);
    stromboli::logging::error(message);
    return int(code);
}

/// What is printed must have been written, too.
int finished(int code) try {
    stromboli::nowDoing("ending", stromboli::StatusLine::OfOthers);
    stromboli::finishStandardOutput();
    return code;
} catch (const stromboli::Error& error) {
    return fail(error.what(), error.code());
}

} // namespace

int main(int argc, char** argv) {
    using stromboli::ExitCode;
    stromboli::reserveStandardStreams();
    stromboli::setUpLogging(stromboli::Verbosity::Normal);
    keepFreedMemory();
    stromboli::vulkan::useWideVectors();
    try {
        return finished(runLine({argv + 1, argv + argc}));
    } catch (const stromboli::Error& error) {
        return fail(error.what(), error.code());
    } catch (const std::bad_alloc&) {
        return fail("out of memory", ExitCode::Scene);
    } catch (const std::exception& error) {
        if (std::ferror(stdout)) return finished(int(ExitCode::Output)); // fmt could not print
        return fail(error.what(), ExitCode::Device);
    }
}

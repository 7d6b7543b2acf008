#include "host/cli/commands.hpp"
#include "host/cli/options.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/vulkan/vector_width.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <exception>
#include <new>
#include <thread>

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
    case Command::Devices:
        return stromboli::devicesCommand(options);
    case Command::Bench:
        return stromboli::benchCommand(options);
    case Command::Compare:
        return stromboli::compareCommand(options);
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

} // namespace

int main(int argc, char** argv) {
    stromboli::setUpLogging(stromboli::Verbosity::Normal);
    keepFreedMemory();
    stromboli::vulkan::useWideVectors();
    try {
        const auto options = stromboli::parseOptions({argv + 1, argv + argc});
        if (!options) return 0;
        stromboli::setUpLogging(options->verbosity);
        return run(*options);
    } catch (const stromboli::Error& error) {
        stromboli::logging::error(error.what());
        return int(error.code());
    } catch (const std::bad_alloc&) {
        stromboli::logging::error("out of memory");
        return int(stromboli::ExitCode::Scene);
    } catch (const std::exception& error) {
        stromboli::logging::error(error.what());
        return int(stromboli::ExitCode::Device);
    }
}

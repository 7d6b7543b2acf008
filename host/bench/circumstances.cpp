#include "host/bench/circumstances.hpp"

#include "host/version/version.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <sys/utsname.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

namespace stromboli::bench {
namespace {

/// "model name" of /proc/cpuinfo, as Linux states it.
std::string cpuName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0) {
            const size_t colon = line.find(": ");
            if (colon != std::string::npos) return line.substr(colon + 2);
        }
    return "unknown CPU";
}

std::string systemName() {
    utsname name{};
    uname(&name);
    return fmt::format("{} {} {}", name.sysname, name.release, name.machine);
}

uint32_t cores() {
    return std::max(1u, std::thread::hardware_concurrency());
}

} // namespace

uint32_t deviceThreads(const vulkan::DeviceDescription& device) {
    if (!device.isCpu()) return 0;
    const char* wanted = std::getenv("LP_NUM_THREADS");
    const int number = wanted ? std::atoi(wanted) : 0;
    return number > 0 ? uint32_t(number) : cores();
}

Circumstances circumstancesOf(const vulkan::DeviceDescription& device, const OpenedEmbree& embree,
                              uint32_t threads, const std::string& commandLine) {
    Circumstances c;
    c.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    c.commandLine = commandLine;
    c.version = version();
    c.cpu = cpuName();
    c.system = systemName();
    c.cores = cores();
    c.threads = threads;
    c.device = device.name();
    c.driver = device.driver;
    c.deviceIsCpu = device.isCpu();
    c.compiler = STROMBOLI_COMPILER;
    c.embreeMissing = embree.missing;
    if (embree.embree) {
        c.embreeVersion = embree.embree->version();
        c.embreeFlags = embree.embree->compiledWith();
    }
    return c;
}

} // namespace stromboli::bench

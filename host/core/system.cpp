#include "host/core/system.hpp"

#include <dlfcn.h>
#include <fstream>
#include <unistd.h>
#include <utility>

namespace stromboli {

// --- Memory --------------------------------------------------------------------------------------

uint64_t physicalMemory() {
    return uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGE_SIZE));
}

uint64_t residentMemory() {
    std::ifstream file("/proc/self/statm");
    uint64_t all = 0, resident = 0; // pages
    return file >> all >> resident ? resident * uint64_t(sysconf(_SC_PAGE_SIZE)) : 0;
}

// --- Shared libraries ----------------------------------------------------------------------------

SharedLibrary::SharedLibrary(std::string name, const std::string& package)
    : name_(std::move(name)), handle_(dlopen(name_.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (!handle_) missing_ = name_ + " is not installed; on Debian: apt install " + package;
}

void* SharedLibrary::address(const char* name) {
    if (!handle_) return nullptr;
    void* const found = dlsym(handle_, name);
    if (!found) missing_ = name_ + " has no " + name;
    return found;
}

} // namespace stromboli

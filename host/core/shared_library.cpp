#include "host/core/shared_library.hpp"

#include <dlfcn.h>

#include <utility>

namespace stromboli {

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

// Preloaded into the program (LD_PRELOAD), it kills the process at the n-th time that it writes to
// a file of the folder that STROMBOLI_KILL_FOLDER names, forces one to the disk or renames one;
// STROMBOLI_KILL_AT is n. So a test is killed by the work that was done and not by the clock: on a
// machine that is busy with other things it is killed in the same places.
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <string>
#include <unistd.h>

namespace {

const char* folder() {
    static const char* const name = std::getenv("STROMBOLI_KILL_FOLDER");
    return name;
}

bool liesThere(const char* path) {
    return folder() && std::strncmp(path, folder(), std::strlen(folder())) == 0;
}

bool liesThere(int descriptor) {
    if (!folder() || descriptor <= STDERR_FILENO) return false;
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    char path[4096] = {};
    return ::readlink(link.c_str(), path, sizeof path - 1) > 0 && liesThere(path);
}

/// Another of the calls that are counted.
void count() {
    static std::atomic<long> left = [] {
        const char* const at = std::getenv("STROMBOLI_KILL_AT");
        return at ? std::atol(at) : 0;
    }();
    if (left.fetch_sub(1) == 1) ::raise(SIGKILL);
}

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

} // namespace

// The program is to find these in place of the C library's.
#pragma GCC visibility push(default)
extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t size) {
    static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
    if (liesThere(descriptor)) count();
    return real(descriptor, bytes, size);
}

int fsync(int descriptor) {
    static auto* const real = next<int(int)>("fsync");
    if (liesThere(descriptor)) count();
    return real(descriptor);
}

int rename(const char* from, const char* to) {
    static auto* const real = next<int(const char*, const char*)>("rename");
    const bool counts = liesThere(to);
    if (counts) count();
    const int result = real(from, to);
    if (counts) count(); // with the new name there
    return result;
}
}
#pragma GCC visibility pop

#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <type_traits>

namespace stromboli {

// --- Memory --------------------------------------------------------------------------------------

/// The memory of this machine in bytes: what no single thing can need more of.
uint64_t physicalMemory();
/// What this process has of it now; 0 where the system does not tell.
uint64_t residentMemory();

// --- Time ----------------------------------------------------------------------------------------

/// Wall-clock time since it was made.
class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// --- Shared libraries ----------------------------------------------------------------------------

/// A library that is opened when it is first wanted, and stays open: linked with the program, it
/// would be loaded at every start of it.
class SharedLibrary {
  public:
    /// name: as the linker has it ("libembree3.so.3"); package: Debian's, for the message.
    SharedLibrary(std::string name, const std::string& package);

    /// Sets a pointer to the function of this name, or to null.
    template <class Function>
    void find(Function*& function, const char* name) {
        function = reinterpret_cast<Function*>(address(name));
    }
    /// Why it cannot be used: it is not there, or lacks one of the functions that were looked for.
    /// Empty: it can.
    const std::string& missing() const { return missing_; }

  private:
    void* address(const char* name);

    std::string name_, missing_;
    void* handle_;
};

} // namespace stromboli

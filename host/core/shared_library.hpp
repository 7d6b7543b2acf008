#pragma once

#include <string>
#include <type_traits>

namespace stromboli {

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

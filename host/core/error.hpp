#pragma once

#include <stdexcept>
#include <string>

namespace stromboli {

/// Exit codes of the program; the numbers are part of its interface (README, "Exit codes"). 5 is
/// that of the `stromboli` script where it cannot build the program.
enum class ExitCode : int {
    Success = 0,
    Usage = 1,
    Scene = 2,
    Device = 3,
    Output = 4,
    Undecided = 6,
    NothingLeft = 7
};

/// Base of every error a user can cause. Caught once, in main, which prints what() and exits
/// with code(). The message is one line: where (file:line, element), what is wrong, what was
/// expected.
class Error : public std::runtime_error {
  public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

/// The command line asks for something impossible.
class UsageError : public Error {
  public:
    explicit UsageError(const std::string& message) : Error(ExitCode::Usage, message) {}
};

/// The scene file cannot be read or makes no sense.
class SceneError : public Error {
  public:
    explicit SceneError(const std::string& message) : Error(ExitCode::Scene, message) {}
    /// `file:line: <element>: message`; line 0 (unknown) and an empty element are left out.
    SceneError(const std::string& file, int line, const std::string& element,
               const std::string& message);
};

/// No usable Vulkan device, a device limit, or a device that failed.
class DeviceError : public Error {
  public:
    explicit DeviceError(const std::string& message) : Error(ExitCode::Device, message) {}
};

/// The device stopped working; another try may succeed.
class DeviceLostError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

/// A picture or report cannot be written.
class OutputError : public Error {
  public:
    explicit OutputError(const std::string& message) : Error(ExitCode::Output, message) {}
};

} // namespace stromboli

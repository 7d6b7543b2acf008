#pragma once

#include <stdexcept>
#include <string>

namespace stromboli {

/// What went wrong. What a program does about it is its own business.
enum class ErrorKind {
    Usage,      ///< what is asked for makes no sense
    Scene,      ///< the scene cannot be read or makes no sense
    Device,     ///< there is no usable device, or it fails
    DeviceLost, ///< the device stopped working; another try may succeed
    Output      ///< a file cannot be written
};

/// Base of every error a user can cause. The message is one line: where (file:line, element), what
/// is wrong, what was expected.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    ErrorKind kind() const { return kind_; }

  private:
    ErrorKind kind_;
};

/// What is asked for is impossible.
class UsageError : public Error {
  public:
    explicit UsageError(const std::string& message) : Error(ErrorKind::Usage, message) {}
};

/// The scene file cannot be read or makes no sense.
class SceneError : public Error {
  public:
    explicit SceneError(const std::string& message) : Error(ErrorKind::Scene, message) {}
    /// `file:line: <element>: message`; line 0 (unknown) and an empty element are left out.
    SceneError(const std::string& file, int line, const std::string& element,
               const std::string& message);
};

/// No usable Vulkan device, a device limit, or a device that failed.
class DeviceError : public Error {
  public:
    explicit DeviceError(const std::string& message, ErrorKind kind = ErrorKind::Device)
        : Error(kind, message) {}
};

/// The device stopped working; another try may succeed.
class DeviceLostError : public DeviceError {
  public:
    explicit DeviceLostError(const std::string& message)
        : DeviceError(message, ErrorKind::DeviceLost) {}
};

/// A picture or report cannot be written.
class OutputError : public Error {
  public:
    explicit OutputError(const std::string& message) : Error(ErrorKind::Output, message) {}
};

} // namespace stromboli

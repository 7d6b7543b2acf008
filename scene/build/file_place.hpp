#pragma once

#include <string>

namespace stromboli::build {

/// A place in a scene file, for messages about it.
struct FilePlace {
    std::string file;
    int line = 0;        ///< from 1; 0 where the format has no lines
    std::string element; ///< what stands there, by the format's own name; empty if it has none

    /// `file:line: <element>: message`.
    std::string describe(const std::string& message) const;
    /// Throws SceneError with this line.
    [[noreturn]] void fail(const std::string& message) const;
};

} // namespace stromboli::build

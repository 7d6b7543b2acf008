#pragma once

#include <functional>
#include <string>

namespace stromboli {

/// How much a message matters.
enum class Severity { Detail, Information, Warning };

/// What an engine is busy with.
enum class Stage { Loading, Building, Preparing, Sampling, Looking, Writing };

/// Whom the engine tells what it does. Functions may be empty. They are called on the threads that
/// call the engine, and never after that call has returned.
struct Listener {
    /// A message of one line.
    std::function<void(Severity, const std::string&)> message;
    /// What begins now, in words: "building the BVH of 12 triangles".
    std::function<void(Stage, const std::string&)> activity;

    void detail(const std::string& text) const { say(Severity::Detail, text); }
    void info(const std::string& text) const { say(Severity::Information, text); }
    void warn(const std::string& text) const { say(Severity::Warning, text); }
    void doing(Stage stage, const std::string& what) const {
        if (activity) activity(stage, what);
    }

  private:
    void say(Severity severity, const std::string& text) const {
        if (message) message(severity, text);
    }
};

} // namespace stromboli

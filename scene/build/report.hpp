#pragma once

#include "host/core/error.hpp"
#include "scene/build/file_place.hpp"
#include "scene/build/shortfall.hpp"
#include "scene/model/scene.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace stromboli::build {

/// Counts what a loader skips, so that the user reads one line per kind, not one per element.
class Report {
  public:
    /// `strict`: what would be forgiven is an error.
    explicit Report(bool strict = false) : strict_(strict) {}

    /// `what` (plural-safe, such as "<skew>") had no effect; `why` completes the sentence.
    void ignore(const std::string& what, const std::string& why, size_t count = 1);
    /// `what` changes the picture. Equal lines are counted.
    void warn(const std::string& what);

    /// What stands at `where` breaks the rules of its format, but what is meant can be told:
    /// `problem` says what is wrong, `reading` what is made of it. There is one line for each
    /// reading, with the first place and its problem, and a count. Throws SceneError if strict.
    void forgive(const FilePlace& where, const std::string& problem, const std::string& reading);
    /// The one rule about what cannot be read: a picture is made of the rest, and the table of
    /// kinds (shortfall.hpp) says what takes its place. Forgives, as above.
    void replace(const FilePlace& where, Shortfall kind, const std::string& problem);
    /// Forgives likewise, with a line of its own for each `instead`, which says more exactly what
    /// is taken than the table can.
    void replace(const FilePlace& where, Shortfall kind, const std::string& problem,
                 const std::string& instead);
    /// Forgives an error that was thrown, whose words have their place: it is thrown again where
    /// the reading is strict, and at the end where the scene has nothing to show without it.
    void replace(const Error& error, Shortfall kind);
    /// Adds the lines about a file that the scene's file refers to, but those that `isLeftOut` says
    /// have no meaning here. What was forgiven there throws SceneError if this one is strict.
    void adopt(const LoadReport& other, const std::function<bool(const std::string&)>& isLeftOut);
    /// The first error that was replaced; null if there is none.
    const std::string* firstError() const { return firstError_ ? &*firstError_ : nullptr; }
    /// The file may leave something open, and does: `what`, and what is taken for it.
    void assume(const std::string& what);

    /// Appends the lines, in the order of first mention.
    void writeTo(LoadReport& report) const;

  private:
    /// Lines with counts, in the order of first mention.
    class Counts {
      public:
        void add(const std::string& key, size_t count);
        const std::vector<std::pair<std::string, size_t>>& lines() const { return lines_; }

      private:
        std::vector<std::pair<std::string, size_t>> lines_;
        std::unordered_map<std::string, size_t> index_;
    };

    bool strict_;
    Counts ignored_, warnings_, forgiven_, assumed_;
    std::unordered_map<std::string, std::string> firstForgiven_; ///< the line about the first one
    std::optional<std::string> firstError_;
};

} // namespace stromboli::build

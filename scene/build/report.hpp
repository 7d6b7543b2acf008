#pragma once

#include "scene/model/scene.hpp"

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

namespace stromboli::build {

/// Counts what a loader skips, so that the user reads one line per kind, not one per element.
class Report {
  public:
    /// `what` (plural-safe, such as "<skew>") had no effect; `why` completes the sentence.
    void ignore(const std::string& what, const std::string& why, size_t count = 1);
    /// `what` changes the picture. Equal lines are counted.
    void warn(const std::string& what);

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

    Counts ignored_, warnings_;
};

} // namespace stromboli::build

#pragma once

#include "scene/build/file_place.hpp"
#include "scene/build/report.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::pbrt {

/// Finds the files that a scene names: paths begin in the folder of the scene's first file, as pbrt
/// has it, or else in that of the file that names them.
class Files {
  public:
    Files(std::filesystem::path scene, build::Report& report)
        : folder_(scene.parent_path()), report_(report) {}

    /// Throws SceneError at `where` if it is not there.
    std::filesystem::path find(const build::FilePlace& where, const std::string& name) const;
    /// The numbers of a text file, with commas behind them or not, and comments behind #. Throws
    /// SceneError at `where` if the file holds anything else than numbers; `of` says in the message
    /// what they are meant to be.
    std::vector<double> numbers(const build::FilePlace& where, const std::string& name,
                                std::string_view of) const;

  private:
    std::filesystem::path folder_;
    build::Report& report_;
};

} // namespace stromboli::pbrt

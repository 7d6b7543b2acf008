#pragma once

#include "scene/build/conventions.hpp"
#include "scene/build/report.hpp"
#include "scene/mitsuba/plugin.hpp"

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

namespace stromboli::mitsuba {

/// A Mitsuba scene in memory: the objects of its file and of those that it includes.
class Document {
  public:
    /// Throws SceneError with file, line and element for what is no scene. `definitions` take the
    /// place of the file's <default> values; one that nothing refers to is an error.
    Document(const std::filesystem::path& file, const std::vector<Definition>& definitions,
             build::Report& report);

    const Plugin& scene() const { return *scene_; }

    /// The file is one of the renderer Rainbow, which has Mitsuba 0.5's names: its surfaces reflect
    /// on both sides.
    bool isRainbows() const { return isRainbows_; }

    /// The file that a plugin names by its string `parameter`: in one of the scene's folders.
    std::filesystem::path file(const Plugin& plugin, std::string_view parameter) const;

  private:
    friend class DocumentReader;

    std::filesystem::path find(const build::FilePlace& where, const std::string& name) const;

    std::deque<Plugin> plugins_;
    Plugin* scene_ = nullptr;
    bool isRainbows_ = false;
    std::vector<std::filesystem::path> folders_; ///< in the order in which they are searched
    build::Report& report_;
};

} // namespace stromboli::mitsuba

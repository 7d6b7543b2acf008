#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli::collada {

/// A file beside a document.
struct Companion {
    std::string bytes;
    /// What of the path, as the document writes it, had to be read otherwise than the standard
    /// says, and how; empty where nothing had.
    std::string problem, reading;
};

/// The files that lie with a document: in its folder, or in its archive, and below. Nothing else is
/// ever opened.
class Companions {
  public:
    Companions() = default;
    static Companions inFolder(const std::filesystem::path& folder);
    /// `archive`: its bytes; `document`: the path of the document in it.
    static Companions inArchive(const std::string& file, std::string archive,
                                std::string_view document);

    /// The file that a reference names, relative to the document. A path that leads to no such file
    /// because it is that of another machine names the file of the same name beside the document.
    /// Nothing if there is none; throws SceneError if it cannot be read.
    std::optional<Companion> read(std::string_view reference) const;

  private:
    std::optional<std::string> bytesOf(const std::filesystem::path& relative) const;
    std::optional<std::filesystem::path> belowFolder(const std::filesystem::path& path) const;

    std::filesystem::path folder_; ///< on the disk, or in the archive
    std::string archiveFile_;
    std::shared_ptr<const std::string> archive_; ///< null: the folder is on the disk
};

} // namespace stromboli::collada

#pragma once

#include "scene/build/report.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace stromboli::collada {

/// True if bytes begin as a zip archive does.
bool isArchive(std::string_view bytes);

/// A document that was packed in an archive.
struct PackedDocument {
    std::string name; ///< of the archive and of the document in it, for messages
    std::string path; ///< of the document in the archive
    std::string bytes;
};

/// The document of a COLLADA archive (.zae): the one that its manifest.xml names. An archive
/// without a manifest is forgiven if it has one document. Throws SceneError for archives that are
/// damaged, encrypted, or hold more than fits in memory.
PackedDocument readZae(const std::string& file, std::string_view bytes, build::Report& report);

/// The file of that path in an archive; nothing if it holds none. Throws SceneError as readZae().
std::optional<std::string> readFromArchive(const std::string& file, std::string_view bytes,
                                           const std::string& path);

} // namespace stromboli::collada

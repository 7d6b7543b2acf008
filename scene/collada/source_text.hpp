#pragma once

#include "scene/build/report.hpp"
#include "scene/collada/companions.hpp"

#include <filesystem>
#include <string>

namespace stromboli::collada {

/// The text of a COLLADA document, in UTF-8 without a byte order mark.
struct SourceText {
    std::string name; ///< of the file, and of the document in it where it is an archive
    std::string text;
    Companions companions; ///< the files that lie with it
};

/// Reads a file: a document in UTF-8 or UTF-16, or an archive (.zae) that holds one. Throws
/// SceneError if it cannot be read, or is no text.
SourceText readSourceText(const std::filesystem::path& file, build::Report& report);

} // namespace stromboli::collada

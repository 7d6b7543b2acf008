#include "scene/collada/companions.hpp"

#include "scene/build/companion.hpp"
#include "scene/build/folder.hpp"
#include "scene/build/percent_decoding.hpp"
#include "scene/build/read_file.hpp"
#include "scene/collada/zae.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace stromboli::collada {
namespace {

namespace fs = std::filesystem;

bool leadsOut(const fs::path& normal) {
    return normal.is_absolute() || normal.empty() || *normal.begin() == "..";
}

/// The length of `scheme:` (RFC 3986) or of a drive of Windows such as `C:`; 0 if there is none.
size_t schemeLength(std::string_view reference) {
    const size_t colon = reference.find(':');
    if (colon == std::string_view::npos || colon == 0) return 0;
    for (const char c : reference.substr(0, colon))
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '-' && c != '.')
            return 0;
    return colon + 1;
}

/// A path out of what files have in place of a URI.
struct WrittenPath {
    fs::path path;
    bool isForeign = false; ///< neither relative nor of this machine: a drive, another scheme
    bool hasBackslashes = false, hasWrongScheme = false;
};

WrittenPath parse(std::string_view reference) {
    WrittenPath written;
    std::string_view rest = reference;
    const bool isFile = rest.starts_with("file:");
    if (isFile) {
        rest.remove_prefix(5);
        if (rest.starts_with("//")) rest.remove_prefix(2);
        if (rest.starts_with("localhost/")) rest.remove_prefix(9);
        written.hasWrongScheme = !rest.starts_with('/');
    }
    std::string text = build::percentDecoded(rest);
    written.hasBackslashes = text.find('\\') != std::string::npos;
    std::replace(text.begin(), text.end(), '\\', '/');
    std::string_view path = text;
    // The path of file:///C:/a.png has a slash before the drive.
    if (isFile && path.starts_with('/') && schemeLength(path.substr(1)) == 2) path.remove_prefix(1);
    if (const size_t scheme = schemeLength(path)) {
        written.isForeign = true;
        path.remove_prefix(scheme);
    }
    written.path = fs::path(path).lexically_normal();
    return written;
}

} // namespace

Companions Companions::inFolder(const fs::path& folder) {
    Companions companions;
    companions.folder_ = folder;
    return companions;
}

Companions Companions::inArchive(const std::string& file, std::string archive,
                                 std::string_view document) {
    Companions companions;
    companions.folder_ = fs::path(document).parent_path();
    companions.archiveFile_ = file;
    companions.archive_ = std::make_shared<const std::string>(std::move(archive));
    return companions;
}

std::optional<std::string> Companions::bytesOf(const fs::path& relative) const {
    const fs::path path = (folder_ / relative).lexically_normal();
    if (archive_)
        return leadsOut(path) ? std::nullopt
                              : readFromArchive(archiveFile_, *archive_, path.generic_string());
    std::error_code error;
    const bool isThere = fs::is_regular_file(path, error) && build::liesBelow(folder_, path);
    if (!isThere) return std::nullopt;
    return build::readFile(path);
}

/// An absolute path as one relative to the folder; nothing if it does not lie below it.
std::optional<fs::path> Companions::belowFolder(const fs::path& path) const {
    if (archive_ || !build::liesBelow(folder_, path)) return std::nullopt;
    std::error_code error;
    const fs::path folder = fs::canonical(folder_.empty() ? "." : folder_, error);
    return fs::weakly_canonical(path, error).lexically_relative(folder);
}

std::optional<Companion> Companions::read(std::string_view reference) const {
    // A zero byte would end the name for the system and not for the checks.
    const WrittenPath written = parse(reference);
    if (written.path.native().find('\0') != std::string::npos) return std::nullopt;
    const fs::path& path = written.path;
    const auto say = [&](std::string bytes, const char* problem, const char* reading) {
        return Companion{std::move(bytes), fmt::format("'{}' {}", reference, problem), reading};
    };
    std::optional<fs::path> inside;
    // Within an archive, paths may go up from the document to the archive's top.
    const bool isInside =
        archive_ ? !leadsOut((folder_ / path).lexically_normal()) : !leadsOut(path);
    if (!written.isForeign && path.is_absolute()) inside = belowFolder(path);
    if (!written.isForeign && !path.is_absolute() && isInside) inside = path;
    if (inside)
        if (std::optional<std::string> bytes = bytesOf(*inside)) {
            if (written.hasWrongScheme)
                return say(std::move(*bytes), "has a relative path after file:",
                           "the path counts from the document on");
            if (written.hasBackslashes)
                return say(std::move(*bytes), "has backslashes", "they are read as slashes");
            return Companion{std::move(*bytes), "", ""};
        }
    const fs::path name = path.filename();
    if (name.empty() || name == "." || name == "..") return std::nullopt;
    std::optional<std::string> bytes = bytesOf(name);
    if (!bytes && !archive_) {
        const build::Companion other = build::pictureCompanion(folder_, path.generic_string());
        if (!other.path) return std::nullopt;
        return Companion{build::readFile(*other.path), other.problem, other.reading};
    }
    if (!bytes) return std::nullopt;
    return say(std::move(*bytes), "leads to no file in the document's folder",
               "the file of the same name beside the document is taken");
}

} // namespace stromboli::collada

#include "scene/build/companion.hpp"

#include "scene/build/folder.hpp"
#include "scene/build/percent_decoding.hpp"
#include "scene/build/shortfall.hpp"
#include "scene/build/unicode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <span>
#include <string>
#include <system_error>
#include <utility>

namespace stromboli::build {
namespace {

namespace fs = std::filesystem;

/// A folder of more files than this is not searched for a name with other capitals.
constexpr int kMostEntries = 100000;

bool isThere(const fs::path& folder, const fs::path& relative) {
    if (relative.empty() || relative.is_absolute()) return false;
    std::error_code error;
    const fs::path path = folder / relative;
    return fs::is_regular_file(path, error) && liesBelow(folder, path);
}

bool hasDrive(std::string_view path) {
    return path.size() >= 2 && path[1] == ':' && std::isalpha(static_cast<unsigned char>(path[0]));
}

bool leadsOut(const fs::path& normal) {
    return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

std::string inSmallLetters(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

/// The relative path whose parts differ by capitals alone; nothing if there is no such file. Where
/// there are several, the first one of the alphabet.
std::optional<fs::path> withOtherCapitals(const fs::path& folder, const fs::path& relative) {
    fs::path found;
    for (const fs::path& part : relative) {
        const std::string wanted = inSmallLetters(part.string());
        std::optional<fs::path> match;
        std::error_code error;
        int entries = 0;
        const fs::path searched = folder / found;
        fs::directory_iterator entry(searched.empty() ? "." : searched, error);
        for (; !error && entry != fs::directory_iterator() && ++entries < kMostEntries;
             entry.increment(error)) {
            const fs::path name = entry->path().filename();
            const bool isSame = inSmallLetters(name.string()) == wanted;
            if (isSame && (!match || name < *match)) match = name;
        }
        if (!match) return std::nullopt;
        found /= *match;
    }
    if (!isThere(folder, found)) return std::nullopt;
    return found;
}

std::string quoted(std::string_view name) {
    constexpr size_t longest = 60;
    return fmt::format("'{}{}'", name.substr(0, longest), name.size() > longest ? "..." : "");
}

Companion companionNamed(const fs::path& folder, std::string_view written) {
    // A zero byte would end the name for the system and not for the checks.
    if (written.empty() || written.find('\0') != std::string_view::npos) return {};
    const auto otherCapitals = [&](const fs::path& path) {
        return Companion{folder / path, fmt::format("{} has other capitals", quoted(written)),
                         std::string(insteadOf(Shortfall::OtherCapitals))};
    };
    std::string text(written);
    const bool hasBackslashes = text.find('\\') != std::string::npos;
    std::replace(text.begin(), text.end(), '\\', '/');
    const fs::path path = fs::path(text).lexically_normal();
    if (!hasDrive(text) && !leadsOut(path)) {
        if (isThere(folder, path)) {
            if (!hasBackslashes) return {folder / path, "", ""};
            return {folder / path, fmt::format("{} has backslashes", quoted(written)),
                    "they are read as slashes"};
        }
        if (const std::optional<fs::path> other = withOtherCapitals(folder, path))
            return otherCapitals(*other);
    }
    const fs::path name = path.filename();
    if (name.empty() || name == "." || name == "..") return {};
    if (isThere(folder, name))
        return {folder / name,
                fmt::format("{} leads to no file in the file's folder", quoted(written)),
                "the file of the same name beside it is taken"};
    if (const std::optional<fs::path> other = withOtherCapitals(folder, name))
        return otherCapitals(*other);
    return {};
}

/// The endings of pictures that are read, in the order in which one takes the place of another;
/// that of one more, which holds data and takes no place; and those of others that scenes name.
constexpr std::string_view kRead[] = {".png", ".jpg", ".jpeg", ".webp", ".tga", ".bmp",
                                      ".gif", ".tif", ".tiff", ".dds",  ".exr", ".hdr"};
constexpr std::string_view kFloats = ".pfm";
constexpr std::string_view kUnread[] = {".psd", ".ktx", ".ktx2", ".avif", ".jxl"};

/// What is left where a name ends in a dot and some letters.
std::string_view withoutEnding(std::string_view name) {
    const size_t dot = name.find_last_of('.');
    const bool isEnding =
        dot != std::string_view::npos && name.find_first_of("/\\", dot) == std::string_view::npos;
    return isEnding ? name.substr(0, dot) : name;
}

std::string endingOf(std::string_view name) {
    return inSmallLetters(std::string(name.substr(withoutEnding(name).size())));
}

bool isAmong(std::span<const std::string_view> endings, const std::string& ending) {
    return std::ranges::find(endings, ending) != endings.end();
}

bool endsAsPicture(std::string_view name) {
    const std::string ending = endingOf(name);
    return isAmong(kRead, ending) || isAmong(kUnread, ending) || ending == kFloats;
}

/// As the name is written, or else with the codes of a URI, or in Latin-1.
Companion companionRead(const fs::path& folder, std::string_view written) {
    Companion found = companionNamed(folder, written);
    if (found.path) return found;
    const std::pair<std::string, std::string_view> others[] = {
        {percentDecoded(written), "is written as in a URI"},
        {utf8WithLatin1(written), "is no UTF-8 but Latin-1"}};
    for (const auto& [reading, what] : others) {
        if (reading == written) continue;
        Companion other = companionNamed(folder, reading);
        if (!other.path) continue;
        if (!other.problem.empty()) return other;
        return {other.path, fmt::format("{} {}", quoted(written), what), "it is read so"};
    }
    return {};
}

} // namespace

Companion companion(const fs::path& folder, std::string_view written) {
    if (endsAsPicture(written)) return pictureCompanion(folder, written);
    return companionRead(folder, written);
}

Companion pictureCompanion(const fs::path& folder, std::string_view written) {
    Companion found = companionRead(folder, written);
    const std::string_view name = withoutEnding(written);
    const bool isUnread = isAmong(kUnread, endingOf(written));
    if ((found.path && !isUnread) || name.empty()) return found;
    for (const std::string_view ending : kRead)
        if (const Companion other = companionRead(folder, fmt::format("{}{}", name, ending));
            other.path)
            return {other.path,
                    fmt::format("{} is {}", quoted(written),
                                found.path ? "of a kind that is not read" : "not there"),
                    "the picture of the same name with another ending is taken"};
    return found;
}

} // namespace stromboli::build

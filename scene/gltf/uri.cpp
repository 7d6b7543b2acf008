#include "scene/gltf/uri.hpp"

#include "host/core/error.hpp"
#include "scene/build/companion.hpp"
#include "scene/build/folder.hpp"
#include "scene/build/percent_decoding.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/unicode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <system_error>

namespace stromboli::gltf {
namespace {

namespace fs = std::filesystem;

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62; // RFC 4648: the second is that of URLs
    if (c == '/' || c == '_') return 63;
    return -1;
}

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// Nothing if a character is not of the alphabet. Lines may be broken.
std::optional<std::string> fromBase64(std::string_view text) {
    while (text.ends_with('=') || (!text.empty() && isBlank(text.back())))
        text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0, count = 0;
    for (const char c : text) {
        if (isBlank(c)) continue;
        const int digit = base64Digit(c);
        if (digit < 0) return std::nullopt;
        bits = bits << 6 | uint32_t(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += char(bits >> count & 0xFF);
    }
    return bytes;
}

/// `scheme:` at the beginning (RFC 3986); one letter alone is a drive of Windows, which is no
/// better.
bool hasScheme(std::string_view uri) {
    const size_t colon = uri.find(':');
    if (colon == std::string_view::npos || uri.find('/') < colon) return false;
    for (const char c : uri.substr(0, colon))
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '-' && c != '.')
            return false;
    return colon > 0;
}

/// Words of URIs are alike in capitals and small letters.
bool isWord(std::string_view text, std::string_view word) {
    return std::ranges::equal(text, word, [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == b;
    });
}

bool isData(std::string_view uri) {
    constexpr std::string_view scheme = "data:";
    return isWord(uri.substr(0, scheme.size()), scheme);
}

/// What stands behind the comma of a data URI (RFC 2397), of which any character may be written by
/// its code.
std::string bytesOfData(std::string_view uri, const build::FilePlace& place) {
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos) place.fail("the data URI has no comma");
    std::string_view kind = uri.substr(0, comma);
    while (!kind.empty() && isBlank(kind.back()))
        kind.remove_suffix(1);
    const std::string_view encoding = kind.substr(std::min(kind.find_last_of("; "), kind.size()));
    const std::string_view data = uri.substr(comma + 1);
    if (encoding.empty() || !isWord(encoding.substr(1), "base64"))
        return build::percentDecoded(data);
    const bool hasCodes = data.find('%') != std::string_view::npos;
    std::optional<std::string> bytes = fromBase64(hasCodes ? build::percentDecoded(data) : data);
    if (!bytes) place.fail("the data URI is no base64");
    return std::move(*bytes);
}

bool leadsOut(std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    const fs::path path = fs::path(name).lexically_normal();
    return path.is_absolute() || (!path.empty() && *path.begin() == "..");
}

/// The file that a URI stands for, read as the format wants it or else as it is written: programs
/// forget to encode a percent sign, and write names in the code of their machine. Of a place on
/// another machine no more than the name counts.
build::Companion companionOf(const fs::path& folder, std::string_view uri) {
    constexpr std::string_view file = "file://";
    const bool isPlace = uri.starts_with(file);
    if (hasScheme(uri) && !isPlace && uri.find(':') > 1) return {};
    const std::string_view written = isPlace ? uri.substr(file.size()) : uri;
    const std::string name = build::percentDecoded(written);
    for (const std::string& reading :
         {name, std::string(written), build::latin1FromUtf8(name).value_or("")})
        if (build::Companion found = build::companion(folder, reading); found.path) return found;
    // What servers are told behind a name.
    const size_t query = written.find_first_of("?#");
    if (query == std::string_view::npos || query == 0) return {};
    build::Companion found =
        build::companion(folder, build::percentDecoded(written.substr(0, query)));
    if (found.path && found.problem.empty()) {
        found.problem = fmt::format("'{}' has a query", shortUri(uri));
        found.reading = "the name before it is read";
    }
    return found;
}

[[noreturn]] void failToFind(const fs::path& folder, std::string_view uri,
                             const build::FilePlace& place) {
    if (hasScheme(uri))
        place.fail(
            fmt::format("the URI '{}' is no relative path; only files are read", shortUri(uri)));
    const std::string name = build::percentDecoded(uri);
    // A zero byte would end the name for the system and not for the checks.
    if (name.find('\0') != std::string::npos || leadsOut(name))
        place.fail(fmt::format("the URI '{}' leads out of the file's folder", shortUri(uri)));
    const fs::path path = folder / fs::path(name);
    std::error_code error;
    if (fs::exists(path, error) && !build::liesBelow(folder, path))
        place.fail(fmt::format("the URI '{}' is a link out of the file's folder", shortUri(uri)));
    if (fs::exists(path, error)) place.fail(fmt::format("'{}' is no file", shortUri(uri)));
    try {
        build::readFile(path);
    } catch (const SceneError& notThere) {
        place.fail(notThere.what());
    }
    place.fail(fmt::format("'{}' was not there", shortUri(uri)));
}

} // namespace

std::string shortUri(std::string_view uri) {
    if (isData(uri))
        return std::string(uri.substr(0, std::min<size_t>(uri.find(','), 60))) + ",...";
    return std::string(uri.substr(0, 200));
}

std::string readUri(const fs::path& folder, std::string_view uri, const build::FilePlace& place,
                    build::Report& report) {
    if (isData(uri)) return bytesOfData(uri, place);
    if (uri.empty()) place.fail("the URI is empty");
    const build::Companion found = companionOf(folder, uri);
    if (!found.path) failToFind(folder, uri, place);
    if (!found.problem.empty()) report.forgive(place, found.problem, found.reading);
    try {
        return build::readFile(*found.path);
    } catch (const SceneError& error) {
        place.fail(error.what());
    }
}

} // namespace stromboli::gltf

#include "scene/gltf/uri.hpp"

#include "host/core/error.hpp"
#include "scene/build/folder.hpp"
#include "scene/build/read_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <optional>

namespace stromboli::gltf {
namespace {

namespace fs = std::filesystem;

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string withoutPercents(std::string_view text) {
    std::string decoded;
    for (size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 &&
                            hexDigit(text[i + 2]) >= 0;
        decoded += escape ? char(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])) : text[i];
        if (escape) i += 2;
    }
    return decoded;
}

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62; // RFC 4648: the second is that of URLs
    if (c == '/' || c == '_') return 63;
    return -1;
}

/// Nothing if a character is not of the alphabet.
std::optional<std::string> fromBase64(std::string_view text) {
    while (text.ends_with('='))
        text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0, count = 0;
    for (const char c : text) {
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

bool leadsOut(const fs::path& path) {
    if (path.is_absolute()) return true;
    for (const fs::path& part : path)
        if (part == "..") return true;
    return false;
}

} // namespace

std::string shortUri(std::string_view uri) {
    if (uri.starts_with("data:"))
        return std::string(uri.substr(0, std::min<size_t>(uri.find(','), 60))) + ",...";
    return std::string(uri.substr(0, 200));
}

std::string readUri(const fs::path& folder, std::string_view uri, const std::string& file,
                    const std::string& element) {
    const auto fail = [&](const std::string& message) {
        throw SceneError(file, 0, element, message);
    };
    if (uri.starts_with("data:")) {
        const size_t comma = uri.find(',');
        if (comma == std::string_view::npos) fail("the data URI has no comma");
        if (!uri.substr(0, comma).ends_with(";base64"))
            return withoutPercents(uri.substr(comma + 1));
        const std::optional<std::string> bytes = fromBase64(uri.substr(comma + 1));
        if (!bytes) fail("the data URI is no base64");
        return *bytes;
    }
    if (uri.empty()) fail("the URI is empty");
    if (hasScheme(uri))
        fail(fmt::format("the URI '{}' is no relative path; only files are read", shortUri(uri)));
    const std::string name = withoutPercents(uri);
    // A zero byte would end the name for the system and not for the checks.
    if (name.find('\0') != std::string::npos || name.find('\\') != std::string::npos ||
        leadsOut(fs::path(name)))
        fail(fmt::format("the URI '{}' leads out of the file's folder", shortUri(uri)));
    const fs::path path = folder / fs::path(name);
    if (fs::exists(path) && !build::liesBelow(folder, path))
        fail(fmt::format("the URI '{}' is a link out of the file's folder", shortUri(uri)));
    try {
        return build::readFile(path);
    } catch (const SceneError& error) {
        fail(error.what());
    }
    return {};
}

} // namespace stromboli::gltf

#include "scene/collada/source_text.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/unicode.hpp"
#include "scene/collada/zae.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace stromboli::collada {
namespace {

[[noreturn]] void fail(const std::string& name, int line, const std::string& message) {
    throw SceneError(name, line, "", message);
}

std::string toUtf8(const std::string& name, std::string bytes, build::Report& report) {
    if (bytes.starts_with("\xEF\xBB\xBF")) return bytes.substr(3);
    const std::optional<build::Utf16Beginning> utf16 = build::utf16Beginning(bytes);
    if (!utf16) return bytes;
    if (!utf16->marked)
        report.forgive({name, 1, ""}, "the text is UTF-16 without a byte order mark",
                       "its first character shows the order");
    std::optional<std::string> text =
        build::utf8FromUtf16(std::string_view(bytes).substr(utf16->marked ? 2 : 0), utf16->order);
    if (!text)
        fail(name, 0, "begins as UTF-16, but is not: it has half a character (is it cut short?)");
    return std::move(*text);
}

/// The kind of a file that is something else, by how it begins; empty if that says nothing.
const char* otherKind(std::string_view bytes) {
    constexpr std::pair<std::string_view, const char*> kinds[] = {
        {"\x89PNG", "a PNG picture"},
        {"\xFF\xD8\xFF", "a JPEG picture"},
        {"glTF", "a glTF binary file"},
        {"\x1F\x8B", "compressed by gzip"},
        {"Kaydara FBX", "an FBX file"},
        {"BLENDER", "a Blender file"},
        {"\x7F"
         "ELF",
         "a program"},
    };
    for (const auto& [beginning, kind] : kinds)
        if (bytes.starts_with(beginning)) return kind;
    return nullptr;
}

/// XML is text whose first character, apart from white space, is `<`.
void requireMarkup(const std::string& name, std::string_view text) {
    if (const char* kind = otherKind(text)) fail(name, 0, fmt::format("is {}, expected XML", kind));
    const size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) fail(name, 0, "the file is empty, expected XML");
    if (const size_t nul = text.find('\0'); nul != std::string_view::npos) {
        const auto lines = std::count(text.begin(), text.begin() + std::ptrdiff_t(nul), '\n');
        fail(name, int(lines) + 1, "has a byte of value 0: it is binary or damaged, expected XML");
    }
    if (text[first] != '<')
        fail(name, 0,
             fmt::format("is not XML: it begins with '{}' where '<' was expected",
                         text.substr(first, std::min(text.find('\n', first), first + 20) - first)));
}

} // namespace

SourceText readSourceText(const std::filesystem::path& file, build::Report& report) {
    SourceText source{file.string(), build::readFile(file),
                      Companions::inFolder(file.parent_path())};
    if (isArchive(source.text)) {
        PackedDocument packed = readZae(source.name, source.text, report);
        source.name = std::move(packed.name);
        source.companions =
            Companions::inArchive(file.string(), std::move(source.text), packed.path);
        source.text = std::move(packed.bytes);
    }
    source.text = toUtf8(source.name, std::move(source.text), report);
    requireMarkup(source.name, source.text);
    return source;
}

} // namespace stromboli::collada

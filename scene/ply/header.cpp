#include "scene/ply/header.hpp"

#include "scene/build/number_word.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace stromboli::ply {
namespace {

struct TypeName {
    std::string_view name, shortName;
    ScalarType type;
    size_t size;
};
constexpr TypeName kTypes[] = {
    {"char", "int8", ScalarType::Int8, 1},
    {"uchar", "uint8", ScalarType::UInt8, 1},
    {"short", "int16", ScalarType::Int16, 2},
    {"ushort", "uint16", ScalarType::UInt16, 2},
    {"int", "int32", ScalarType::Int32, 4},
    {"uint", "uint32", ScalarType::UInt32, 4},
    {"float", "float32", ScalarType::Float32, 4},
    {"double", "float64", ScalarType::Float64, 8},
    // Not in the format; programs that know no other whole numbers write them.
    {"int64", "long", ScalarType::Int64, 8},
    {"uint64", "ulong", ScalarType::UInt64, 8}};

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string shortened(std::string_view word) {
    return std::string(word.substr(0, 60));
}

/// Reads the lines of a header. They end in "\n", with or without "\r" before it, or in "\r", as
/// the first of them does.
class HeaderReader {
  public:
    HeaderReader(const std::string& file, std::string_view bytes, build::Report& report)
        : file_(file), bytes_(bytes), report_(report) {}

    Header read() {
        if (bytes_.starts_with(kByteOrderMark)) header_.end = kByteOrderMark.size();
        const size_t end = bytes_.find_first_of("\r\n");
        if (end == std::string_view::npos ||
            bytes_.substr(header_.end, end - header_.end) != "ply") {
            header_.lines = 1;
            fail("is no PLY file: expected 'ply' and the end of the line");
        }
        newline_ = bytes_[end] == '\n' || bytes_.substr(end, 2) == "\r\n" ? '\n' : '\r';
        takeLine();
        while (readStatement(takeLine())) {
        }
        if (!hasFormat_) fail("ends the header without a line 'format'");
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const { place().fail(message); }
    build::FilePlace place() const { return {file_, header_.lines, ""}; }

    std::string_view takeLine() {
        ++header_.lines;
        const size_t end = bytes_.find(newline_, header_.end);
        if (end == std::string_view::npos)
            fail("the file ends within the header: expected a line 'end_header'");
        std::string_view line = bytes_.substr(header_.end, end - header_.end);
        header_.end = end + 1;
        while (line.ends_with('\r'))
            line.remove_suffix(1);
        rest_ = line;
        return takeWord();
    }

    std::string_view takeWord() {
        constexpr std::string_view space = " \t";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(space), rest_.size()));
        const std::string_view word = rest_.substr(0, rest_.find_first_of(space));
        rest_.remove_prefix(word.size());
        return word;
    }

    /// False for the last one.
    bool readStatement(std::string_view keyword) {
        if (keyword == "end_header") return false;
        if (keyword == "format")
            readFormat();
        else if (keyword == "element")
            readElement();
        else if (keyword == "property")
            readProperty();
        else if (keyword == "comment" || keyword == "obj_info")
            readComment();
        else if (!keyword.empty())
            report_.forgive(place(),
                            fmt::format("'{}' is no keyword of a header", shortened(keyword)),
                            "the line is skipped");
        return true;
    }

    void readComment() {
        const std::string word = inSmallLetters(takeWord());
        if (word != "texturefile" && word != "texturefile:") return;
        const size_t first = rest_.find_first_not_of(" \t");
        if (first == std::string_view::npos) return;
        std::string_view name = rest_.substr(first, rest_.find_last_not_of(" \t") - first + 1);
        if (name.size() > 2 && name.starts_with('"') && name.ends_with('"'))
            name = name.substr(1, name.size() - 2);
        header_.pictures.emplace_back(name);
    }

    void readFormat() {
        const std::string_view name = takeWord();
        if (name == "ascii")
            header_.encoding = Encoding::Ascii;
        else if (name == "binary_little_endian")
            header_.encoding = Encoding::LittleEndian;
        else if (name == "binary_big_endian")
            header_.encoding = Encoding::BigEndian;
        else
            fail(fmt::format("the format is '{}', expected ascii, binary_little_endian or "
                             "binary_big_endian",
                             shortened(name)));
        const std::string_view version = takeWord();
        if (version != "1.0")
            report_.forgive(place(), fmt::format("the version is '{}'", shortened(version)),
                            "the file is read as version 1.0");
        hasFormat_ = true;
    }

    void readElement() {
        Element element;
        element.name = inSmallLetters(takeWord());
        const std::string_view word = takeWord();
        const std::optional<int64_t> count = build::integerIn(word);
        if (element.name.empty() || !count || *count < 0)
            fail(fmt::format("expected 'element NAME COUNT', the count is '{}'", shortened(word)));
        if (header_.find(element.name))
            fail(fmt::format("there is an element '{}' already", shortened(element.name)));
        element.count = uint64_t(*count);
        header_.elements.push_back(std::move(element));
    }

    void readProperty() {
        if (header_.elements.empty()) fail("there is no element before this property");
        Property property;
        std::string_view type = takeWord();
        if (type == "list") {
            property.countType = typeOf(takeWord());
            if (*property.countType == ScalarType::Float32 ||
                *property.countType == ScalarType::Float64)
                fail("the length of a list is no floating-point number");
            type = takeWord();
        }
        property.type = typeOf(type);
        property.name = takeWord();
        if (property.name.empty()) fail("expected 'property TYPE NAME'");
        header_.elements.back().properties.push_back(std::move(property));
    }

    ScalarType typeOf(std::string_view word) const {
        for (const TypeName& type : kTypes)
            if (word == type.name || word == type.shortName) return type.type;
        fail(fmt::format("'{}' is no type; expected char, uchar, short, ushort, int, uint, float, "
                         "double or list",
                         shortened(word)));
    }

    const std::string& file_;
    std::string_view bytes_, rest_;
    char newline_ = '\n';
    build::Report& report_;
    Header header_;
    bool hasFormat_ = false;
};

} // namespace

std::string inSmallLetters(std::string_view name) {
    std::string small(name);
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return small;
}

size_t sizeOf(ScalarType type) {
    return kTypes[size_t(type)].size;
}

const Element* Header::find(std::string_view name) const {
    const auto found = std::find_if(elements.begin(), elements.end(),
                                    [&](const Element& e) { return e.name == name; });
    return found == elements.end() ? nullptr : &*found;
}

Header readHeader(const std::string& file, std::string_view bytes, build::Report& report) {
    return HeaderReader(file, bytes, report).read();
}

} // namespace stromboli::ply

#include "scene/obj/statements.hpp"

#include "scene/build/number_word.hpp"
#include "scene/build/unicode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace stromboli::obj {
namespace {

/// find_first_of() of the standard library calls memchr for each character of the text, which took
/// an eighth of the time to load a room.
bool isSpace(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isSpace(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && isSpace(text.back()))
        text.remove_suffix(1);
    return text;
}

std::string inUtf8(const std::string& file, std::string bytes) {
    std::optional<std::string> converted = build::textInUtf8(std::move(bytes));
    if (!converted) build::FilePlace{file, 0, ""}.fail("begins as UTF-16, but is none");
    std::string& text = *converted;
    // How programs of other times end or fill up a file.
    while (text.ends_with('\0') || text.ends_with('\x1A'))
        text.pop_back();
    return std::move(text);
}

/// Those of Wavefront's specification (version 3.0).
constexpr std::string_view kKeywords[] = {
    "v",          "vn",        "vt",    "f",     "fo",     "g",        "o",        "s",
    "usemtl",     "mtllib",    "l",     "p",     "vp",     "cstype",   "deg",      "bmat",
    "step",       "curv",      "curv2", "surf",  "parm",   "trim",     "hole",     "scrv",
    "sp",         "end",       "con",   "mg",    "bevel",  "c_interp", "d_interp", "lod",
    "shadow_obj", "trace_obj", "ctech", "stech", "usemap", "maplib",   "call",     "csh",
    "bsp",        "bzp",       "cdc",   "cdp",   "res"};

} // namespace

void Words::skipSpace() {
    rest_ = trimmed(rest_);
}

std::string_view Words::next() {
    const std::string_view word(rest_.begin(), std::ranges::find_if(rest_, isSpace));
    rest_.remove_prefix(word.size());
    skipSpace();
    return word;
}

Statements::Statements(std::string file, std::string text)
    : file_(std::move(file)), text_(inUtf8(file_, std::move(text))) {}

std::string_view Statements::physicalLine() {
    std::string_view line = std::string_view(text_).substr(at_);
    line = line.substr(0, line.find('\n'));
    line = line.substr(0, line.find('\r'));
    const size_t end = at_ + line.size();
    at_ = end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++nextLine_;
    return line;
}

bool Statements::next() {
    while (at_ < text_.size()) {
        line_ = nextLine_;
        std::string_view line = physicalLine();
        if (line.ends_with('\\') && at_ < text_.size()) {
            joined_ = line;
            while (joined_.ends_with('\\') && at_ < text_.size()) {
                joined_.back() = ' ';
                joined_ += physicalLine();
            }
            line = joined_;
        }
        Words words(line);
        if (words.atEnd()) continue;
        const bool isComment = words.rest().starts_with('#');
        keyword_ = words.next();
        if (isComment && keyword_ != kPaintKeyword) continue;
        rest_ = words.rest();
        return true;
    }
    return false;
}

std::string_view Statements::values() const {
    for (size_t at = rest_.find('#'); at != std::string_view::npos; at = rest_.find('#', at + 1))
        if (at == 0 || rest_[at - 1] != '.') return rest_.substr(0, at);
    return rest_;
}

double Statements::numberOrNan(Words& words) const {
    Words ahead = words;
    const std::optional<double> value = build::realOrNanIn(ahead.next());
    if (!value || !std::isnan(*value)) return number(words);
    words = ahead;
    return *value;
}

double Statements::number(Words& words) const {
    if (words.atEnd()) fail("ends where a number is expected");
    const std::string_view word = words.next();
    const std::optional<double> value = build::realIn(word);
    if (!value) fail(fmt::format("'{}' is no finite number", shortened(word)));
    return *value;
}

bool isObjKeyword(std::string_view keyword) {
    return std::find(std::begin(kKeywords), std::end(kKeywords), keyword) != std::end(kKeywords);
}

std::string inSmallLetters(std::string_view text) {
    std::string small(text);
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return small;
}

std::string shortened(std::string_view word) {
    constexpr size_t longest = 60;
    return word.size() <= longest ? std::string(word)
                                  : std::string(word.substr(0, longest)) + "...";
}

} // namespace stromboli::obj

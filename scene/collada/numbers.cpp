#include "scene/collada/numbers.hpp"

#include "scene/build/number_word.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli::collada {
namespace {

bool isSpace(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// Calls visit(word) for each word of the element's text. Comments may split the text into
/// pieces; they also separate words, as white space does.
template <typename Visit>
void forEachWord(const Element& at, Visit visit) {
    for (const auto* node = at.FirstChild(); node; node = node->NextSibling()) {
        const tinyxml2::XMLText* text = node->ToText();
        if (!text) continue;
        const char* p = text->Value();
        while (true) {
            while (isSpace(*p))
                ++p;
            if (!*p) break;
            const char* begin = p;
            while (*p && !isSpace(*p))
                ++p;
            visit(std::string_view(begin, size_t(p - begin)));
        }
    }
}

/// A word for a message, cut to a bearable length.
std::string quoted(std::string_view word) {
    return word.size() <= 40 ? fmt::format("'{}'", word)
                             : fmt::format("'{}...'", word.substr(0, 40));
}

/// A number with a comma where a point should be, as programs write it that take the user's
/// language for the file's.
std::optional<double> asNumberWithComma(std::string_view word) {
    const size_t comma = word.find(',');
    if (comma == std::string_view::npos || word.find('.') != std::string_view::npos)
        return std::nullopt;
    std::string pointed(word);
    pointed[comma] = '.';
    return build::anyRealIn(pointed);
}

/// `commas` becomes true where the number is forgiven a decimal comma.
double parseNumber(const Document& document, const Element& at, std::string_view word,
                   NonFinite nonFinite, bool& commas) {
    std::optional<double> number = build::anyRealIn(word);
    if (!number) {
        number = asNumberWithComma(word);
        if (!number) document.fail(at, quoted(word) + " is not a number");
        commas = true;
    }
    const double value = *number;
    if (nonFinite == NonFinite::Reject && !std::isfinite(value))
        document.fail(at, quoted(word) + " is not a finite number");
    return value;
}

void forgiveCommas(const Document& document, const Element& at, bool commas) {
    if (commas) document.forgive(at, "has decimal commas", "they are read as points");
}

uint32_t parseIndex(const Document& document, const Element& at, std::string_view word,
                    std::string_view what) {
    const std::optional<uint32_t> value = build::countIn(word);
    if (!value)
        document.fail(
            at, fmt::format("{}{} is not an integer from 0 to 4294967295", what, quoted(word)));
    return *value;
}

} // namespace

std::vector<double> readNumbers(const Document& document, const Element& at, NonFinite nonFinite) {
    std::vector<double> numbers;
    bool commas = false;
    forEachWord(at, [&](std::string_view word) {
        numbers.push_back(parseNumber(document, at, word, nonFinite, commas));
    });
    forgiveCommas(document, at, commas);
    return numbers;
}

std::vector<double> readNumbers(const Document& document, const Element& at, size_t count) {
    std::vector<double> numbers = readNumbers(document, at);
    if (numbers.size() != count)
        document.fail(at, fmt::format("has {} numbers, expected {}", numbers.size(), count));
    return numbers;
}

double readNumber(const Document& document, const Element& at) {
    return readNumbers(document, at, 1)[0];
}

double readNumberOr(const Document& document, const Element& parent, const char* name,
                    double otherwise) {
    const Element* child = parent.FirstChildElement(name);
    return child ? readNumber(document, *child) : otherwise;
}

float toFloat(const Document& document, const Element& at, double number) {
    if (!(std::abs(number) <= double(std::numeric_limits<float>::max())))
        document.fail(at, fmt::format("{} is too large for single precision", number));
    return float(number);
}

glm::vec3 readColor(const Document& document, const Element& at) {
    const std::vector<double> numbers = readNumbers(document, at);
    if (numbers.size() != 3 && numbers.size() != 4)
        document.fail(at,
                      fmt::format("has {} numbers, expected 3 or 4 (a colour)", numbers.size()));
    return {toFloat(document, at, numbers[0]), toFloat(document, at, numbers[1]),
            toFloat(document, at, numbers[2])};
}

std::vector<uint32_t> readIndices(const Document& document, const Element& at) {
    std::vector<uint32_t> indices;
    forEachWord(
        at, [&](std::string_view word) { indices.push_back(parseIndex(document, at, word, "")); });
    return indices;
}

uint32_t readCount(const Document& document, const Element& at, const char* attribute) {
    return parseIndex(document, at, document.requireAttribute(at, attribute),
                      fmt::format("{}=", attribute));
}

uint32_t readCountOr(const Document& document, const Element& at, const char* attribute,
                     uint32_t otherwise) {
    return at.Attribute(attribute) ? readCount(document, at, attribute) : otherwise;
}

double readAttributeOr(const Document& document, const Element& at, const char* attribute,
                       double otherwise) {
    const char* text = at.Attribute(attribute);
    if (!text) return otherwise;
    bool commas = false;
    const double number = parseNumber(document, at, text, NonFinite::Reject, commas);
    forgiveCommas(document, at, commas);
    return number;
}

} // namespace stromboli::collada

#include "host/cli/command_line.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>

namespace stromboli {
namespace {

bool isWholeNumber(const std::string& s) {
    return !s.empty() &&
           std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::optional<std::string> onlyOneThatBegins(const std::string& word,
                                             const std::vector<std::string>& names) {
    std::optional<std::string> found;
    for (const std::string& name : names) {
        if (!name.starts_with(word)) continue;
        if (found) return std::nullopt;
        found = name;
    }
    return found;
}

} // namespace

std::string shellQuoted(const std::string& argument) {
    constexpr const char* kPlain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./:,@%";
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos)
        return argument;
    std::string text = "'";
    for (const char c : argument)
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

std::string commandLine() {
    std::ifstream file("/proc/self/cmdline");
    std::string text;
    for (std::string argument; std::getline(file, argument, '\0');)
        text += (text.empty() ? "" : " ") + shellQuoted(argument);
    return text;
}

std::vector<std::string> fromCs184Spelling(std::vector<std::string> arguments) {
    for (size_t i = 0; i < arguments.size(); ++i) {
        std::string& a = arguments[i];
        const bool numberFollows = i + 1 < arguments.size() && isWholeNumber(arguments[i + 1]);
        if (a == "-f")
            a = "-o";
        else if (a == "-o" && numberFollows)
            a = "--accumulate";
        else if (a == "-p")
            a = "--cell";
    }
    return arguments;
}

size_t editDistance(const std::string& a, const std::string& b) {
    // d[i][j]: between the first i letters of a and the first j of b.
    std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
    for (size_t i = 0; i <= a.size(); ++i)
        for (size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            const size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

std::optional<std::string> nearestName(const std::string& word,
                                       const std::vector<std::string>& names) {
    if (word.empty() || names.empty()) return std::nullopt;
    if (const auto begun = onlyOneThatBegins(word, names)) return begun;
    const auto nearest = std::ranges::min_element(
        names, {}, [&](const std::string& name) { return editDistance(word, name); });
    if (3 * editDistance(word, *nearest) > std::max(word.size(), nearest->size()))
        return std::nullopt;
    return *nearest;
}

} // namespace stromboli

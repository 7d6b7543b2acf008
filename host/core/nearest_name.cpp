#include "host/core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

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

std::string didYouMean(const std::string& word, const std::vector<std::string>& names) {
    const std::optional<std::string> nearest = nearestName(word, names);
    return nearest ? fmt::format("; did you mean {}?", *nearest) : "";
}

std::optional<std::string> nearestFile(const std::filesystem::path& missing) {
    const std::filesystem::path folder = missing.parent_path();
    std::error_code failed; // a folder that is missing too has no files
    std::vector<std::string> names;
    for (const auto& entry :
         std::filesystem::directory_iterator(folder.empty() ? "." : folder, failed))
        if (!entry.is_directory(failed)) names.push_back(entry.path().filename().string());
    std::ranges::sort(names); // folders have no order
    const std::optional<std::string> name = nearestName(missing.filename().string(), names);
    return name ? std::optional((folder / *name).string()) : std::nullopt;
}

std::string didYouMeanFile(const std::filesystem::path& file) {
    std::error_code failed;
    if (std::filesystem::exists(file, failed)) return "";
    const std::optional<std::string> meant = nearestFile(file);
    return meant ? fmt::format("; did you mean {}?", *meant) : "";
}

} // namespace stromboli

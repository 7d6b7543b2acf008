#include "host/checkpoint/band_files.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

struct BandFile {
    fs::path path;
    uint32_t count;
};

/// The number at the front of the text, which is taken off; nothing if there is none.
std::optional<uint32_t> takeNumber(std::string_view& text) {
    uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(size_t(end - text.data()));
    return number;
}

/// The count in "2of5".
std::optional<uint32_t> countIn(std::string_view text) {
    const std::optional<uint32_t> band = takeNumber(text);
    if (!band || !text.starts_with("of")) return std::nullopt;
    text.remove_prefix(2);
    const std::optional<uint32_t> count = takeNumber(text);
    if (!count || !text.empty() || *band < 1 || *band > *count) return std::nullopt;
    return count;
}

std::vector<BandFile> bandFilesOf(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const std::string beginning = file.filename().string() + ".band";
    std::vector<BandFile> found;
    std::error_code error; // a folder that cannot be listed has none
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
        const std::string name = i->path().filename().string();
        if (!name.starts_with(beginning)) continue;
        if (const auto count = countIn(std::string_view(name).substr(beginning.size())))
            found.push_back({i->path(), *count});
    }
    return found;
}

} // namespace

fs::path bandFile(const fs::path& file, size_t band, size_t count) {
    return file.string() + fmt::format(".band{}of{}", band + 1, count);
}

uint32_t bandsKept(const fs::path& file) {
    const std::vector<BandFile> files = bandFilesOf(file);
    for (const BandFile& f : files)
        if (f.count != files.front().count)
            throw UsageError(
                fmt::format("there are checkpoints of {} and of {} bands beside {}, of "
                            "two renders: remove those of the older one",
                            files.front().count, f.count, file.string()));
    return files.empty() ? 0 : files.front().count;
}

void removeBandFiles(const fs::path& file) {
    std::error_code failed;
    for (const BandFile& f : bandFilesOf(file))
        fs::remove(f.path, failed);
}

} // namespace stromboli

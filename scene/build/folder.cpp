#include "scene/build/folder.hpp"

#include <system_error>

namespace stromboli::build {

bool liesBelow(const std::filesystem::path& folder, const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path base =
        std::filesystem::canonical(folder.empty() ? "." : folder, error);
    if (error) return false;
    const std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
    if (error) return false;
    const std::filesystem::path relative = target.lexically_relative(base);
    return !relative.empty() && *relative.begin() != "..";
}

} // namespace stromboli::build

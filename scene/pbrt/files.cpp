#include "scene/pbrt/files.hpp"

#include "scene/build/companion.hpp"

#include <fmt/format.h>

#include <array>
#include <system_error>

namespace stromboli::pbrt {

std::filesystem::path Files::find(const build::FilePlace& where, const std::string& name) const {
    const std::array folders = {folder_, std::filesystem::path(where.file).parent_path()};
    std::error_code error; // a name that cannot be looked up is not there
    for (const std::filesystem::path& folder : folders)
        if (std::filesystem::is_regular_file(folder / name, error)) return folder / name;
    // Files come from machines with other rules for names.
    for (const std::filesystem::path& folder : folders) {
        const build::Companion found = build::companion(folder, name);
        if (!found.path) continue;
        if (!found.problem.empty()) report_.forgive(where, found.problem, found.reading);
        return *found.path;
    }
    where.fail(fmt::format("names the file '{}', which is not there", name));
}

} // namespace stromboli::pbrt

#include "scene/mitsuba/document.hpp"

#include "scene/build/companion.hpp"
#include "scene/mitsuba/document_reader.hpp"

#include <fmt/format.h>

#include <system_error>

namespace stromboli::mitsuba {

Document::Document(const std::filesystem::path& file, const std::vector<Definition>& definitions,
                   build::Report& report)
    : report_(report) {
    DocumentReader(*this, file, definitions, report).read();
}

std::filesystem::path Document::file(const Plugin& plugin, std::string_view parameter) const {
    return find(plugin.place, plugin.requireText(parameter));
}

std::filesystem::path Document::find(const build::FilePlace& where, const std::string& name) const {
    std::error_code error; // a name that cannot be looked up is not there
    for (const std::filesystem::path& folder : folders_)
        if (std::filesystem::exists(folder / name, error)) return folder / name;
    // Files come from machines with other rules for names.
    for (const std::filesystem::path& folder : folders_) {
        const build::Companion found = build::companion(folder, name);
        if (!found.path) continue;
        if (!found.problem.empty()) report_.forgive(where, found.problem, found.reading);
        return *found.path;
    }
    where.fail(fmt::format("names the file '{}', which is not there{}", name,
                           folders_.size() > 1 ? ", nor in the folders that <path> names" : ""));
}

} // namespace stromboli::mitsuba

#include "scene/pbrt/files.hpp"

#include "scene/build/companion.hpp"
#include "scene/build/number_word.hpp"
#include "scene/build/read_file.hpp"
#include "scene/pbrt/tokens.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
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

std::vector<double> Files::numbers(const build::FilePlace& where, const std::string& name,
                                   std::string_view of) const {
    const std::string text = build::readFile(find(where, name));
    std::vector<double> numbers;
    Tokens tokens(text);
    tokens.begin();
    while (tokens.peek().kind != Token::Kind::End) {
        std::string_view word = tokens.take().text;
        if (word.ends_with(',')) word.remove_suffix(1);
        if (word.empty()) continue;
        const std::optional<double> number = build::realIn(word);
        if (!number)
            where.fail(fmt::format("names a file of {} that holds '{}'", of, word.substr(0, 40)));
        numbers.push_back(*number);
    }
    return numbers;
}

} // namespace stromboli::pbrt

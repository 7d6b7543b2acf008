#include "scene/build/read_file.hpp"

#include "host/core/error.hpp"

#include <fstream>
#include <iterator>

namespace stromboli::build {

std::string readFile(const std::filesystem::path& file, size_t most) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
        throw SceneError(file.string(), 0, "", "is a directory, expected a scene file");
    std::ifstream in(file, std::ios::binary);
    if (!in) throw SceneError(file.string(), 0, "", "cannot be opened for reading");
    std::string text;
    if (most == std::numeric_limits<size_t>::max()) {
        text.assign(std::istreambuf_iterator<char>(in), {});
    } else {
        text.resize(most);
        in.read(text.data(), std::streamsize(most));
        text.resize(size_t(in.gcount()));
    }
    if (in.bad()) throw SceneError(file.string(), 0, "", "cannot be read to its end");
    return text;
}

} // namespace stromboli::build

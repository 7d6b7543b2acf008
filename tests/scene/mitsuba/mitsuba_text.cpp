#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

namespace stromboli::test {

std::filesystem::path writeFile(const std::string& name, std::string_view text) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / fmt::format("mitsuba_{}", getpid());
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
}

std::string sceneText(std::string_view inside, std::string_view version) {
    return fmt::format("<scene version=\"{}\">\n{}\n</scene>\n", version, inside);
}

Scene loadText(const std::string& text, const std::vector<Definition>& definitions) {
    SceneConventions conventions;
    conventions.selection.definitions = definitions;
    return loadMitsuba(writeFile("scene.xml", text), conventions);
}

Scene loadInside(std::string_view inside) {
    return loadText(sceneText(inside));
}

std::string problemOf(const std::string& text, const std::vector<Definition>& definitions) {
    try {
        loadText(text, definitions);
    } catch (const SceneError& error) {
        const std::string message = error.what();
        const std::string file = writeFile("scene.xml", text).string();
        return message.starts_with(file + ":") ? message.substr(file.size() + 1) : message;
    }
    return "";
}

std::string problemInside(std::string_view inside) {
    return problemOf(sceneText(inside));
}

} // namespace stromboli::test

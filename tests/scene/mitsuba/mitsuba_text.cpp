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

std::string writePicture(const std::string& name, int width, int height,
                         const std::vector<std::array<unsigned char, 4>>& texels) {
    // TGA: true colour, 32 bits, the first row at the top.
    std::string bytes(18, '\0');
    bytes[2] = 2;
    bytes[12] = char(width & 0xFF), bytes[13] = char(width >> 8);
    bytes[14] = char(height & 0xFF), bytes[15] = char(height >> 8);
    bytes[16] = 32, bytes[17] = 0x28;
    for (const auto& [r, g, b, a] : texels)
        for (const unsigned char value : {b, g, r, a})
            bytes += char(value);
    return writeFile(name, bytes).filename().string();
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

Scene loadOld(std::string_view inside) {
    return loadText(sceneText(inside, "0.6.0"));
}

std::string problemOf(const std::string& text, const std::vector<Definition>& definitions) {
    try {
        SceneConventions conventions;
        conventions.strict = true;
        conventions.selection.definitions = definitions;
        loadMitsuba(writeFile("scene.xml", text), conventions);
    } catch (const SceneError& error) {
        std::string message = error.what();
        constexpr std::string_view kReason = " (an error because of --strict)";
        if (message.ends_with(kReason)) message.resize(message.size() - kReason.size());
        const std::string file = writeFile("scene.xml", text).string();
        return message.starts_with(file + ":") ? message.substr(file.size() + 1) : message;
    }
    return "";
}

std::string problemInside(std::string_view inside) {
    return problemOf(sceneText(inside));
}

std::string problemInOld(std::string_view inside) {
    return problemOf(sceneText(inside, "0.6.0"));
}

} // namespace stromboli::test

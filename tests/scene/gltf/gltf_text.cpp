#include "tests/scene/gltf/gltf_text.hpp"

#include <unistd.h>

#include <fstream>

namespace stromboli::test {

namespace fs = std::filesystem;

std::string toBase64(std::string_view bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

size_t GltfText::widthOf(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

size_t GltfText::addTo(const std::string& array, const std::string& elements) {
    arrays[array].push_back("{" + elements + "}");
    return arrays[array].size() - 1;
}

size_t GltfText::addView(std::string_view bytes, const std::string& more) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const size_t view =
        addTo("bufferViews", fmt::format(R"("buffer": 0, "byteOffset": {}, "byteLength": {}{})",
                                         bytes_.size(), bytes.size(), more));
    bytes_ += bytes;
    return view;
}

size_t GltfText::addTriangle(const std::string& primitive, const std::string& attributes) {
    const size_t positions = addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const size_t mesh =
        addTo("meshes", fmt::format(R"("primitives": [{{"attributes": {{"POSITION": {}{}}}{}}}])",
                                    positions, attributes, primitive));
    const size_t node = addTo("nodes", fmt::format(R"("mesh": {})", mesh));
    arrays["scenes"].assign(1, fmt::format(R"({{"nodes": [{}]}})", node));
    return mesh;
}

std::string GltfText::json(const std::string& buffer) const {
    std::string text;
    for (const auto& [name, value] : members)
        text += fmt::format(R"(, "{}": {})", name, value);
    for (const auto& [name, elements] : arrays)
        text += fmt::format(R"(, "{}": [{}])", name, fmt::join(elements, ", "));
    if (!bytes_.empty() && !arrays.contains("buffers"))
        text += fmt::format(R"(, "buffers": [{{{}"byteLength": {}}}])", buffer, bytes_.size());
    return "{" + text.substr(2) + "}";
}

std::string GltfText::text() const {
    return json(
        fmt::format(R"("uri": "data:application/octet-stream;base64,{}", )", toBase64(bytes_)));
}

std::string GltfText::binary() const {
    const auto word = [](size_t value) {
        std::string bytes;
        for (int i = 0; i < 4; ++i)
            bytes += char(value >> (8 * i) & 0xFF);
        return bytes;
    };
    std::string text = json("");
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string chunks = word(text.size()) + "JSON" + text;
    chunks += word(bytes_.size()) + std::string("BIN\0", 4) + bytes_;
    return "glTF" + word(2) + word(chunks.size() + 12) + chunks;
}

Folder::Folder() {
    static int number = 0;
    path_ = fs::path(testing::TempDir()) / fmt::format("stromboli_gltf_{}_{}", getpid(), ++number);
    fs::create_directories(path_);
}

Folder::~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

fs::path Folder::write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary)
        .write(bytes.data(), std::streamsize(bytes.size()));
    return path_ / name;
}

Scene loadGltfBytes(std::string_view bytes, const SceneConventions& conventions) {
    const Folder folder;
    return loadGltf(folder.write("scene.gltf", bytes), conventions);
}

std::string gltfProblem(std::string_view bytes, const SceneConventions& conventions) {
    const Folder folder;
    const fs::path file = folder.write("scene.gltf", bytes);
    try {
        loadGltf(file, conventions);
    } catch (const SceneError& error) {
        std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
        return message.substr(file.string().size() + 2);
    }
    return "";
}

} // namespace stromboli::test

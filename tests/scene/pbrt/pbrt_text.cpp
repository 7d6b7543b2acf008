#include "tests/scene/pbrt/pbrt_text.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <cmath>
#include <fstream>

namespace stromboli::test {

const char* const kTriangle =
    "\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n";

namespace {

constexpr std::string_view kBeginV4 = "Film \"rgb\" WorldBegin ",
                           kBeginV3 = "Film \"image\" WorldBegin ";

} // namespace

std::filesystem::path writeFile(const std::string& name, std::string_view text) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / fmt::format("pbrt_{}", getpid());
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
}

std::string writePicture(const std::string& name, int width, int height,
                         const std::vector<std::array<unsigned char, 3>>& texels) {
    // TGA: true colour, 24 bits, the first row at the top.
    std::string bytes(18, '\0');
    bytes[2] = 2;
    bytes[12] = char(width & 0xFF), bytes[13] = char(width >> 8);
    bytes[14] = char(height & 0xFF), bytes[15] = char(height >> 8);
    bytes[16] = 24, bytes[17] = 0x20;
    for (const auto& [r, g, b] : texels)
        for (const unsigned char value : {b, g, r})
            bytes += char(value);
    return writeFile(name, bytes).filename().string();
}

std::string writeLight(const std::string& name, int width, int height,
                       const std::vector<std::array<float, 3>>& texels) {
    std::string bytes =
        fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", height, width);
    for (const auto& texel : texels) {
        const float most = std::max({texel[0], texel[1], texel[2], 1e-6f});
        int exponent = 0;
        std::frexp(most, &exponent);
        for (const float value : texel)
            bytes += char(static_cast<unsigned char>(std::ldexp(value, 8 - exponent)));
        bytes += char(static_cast<unsigned char>(exponent + 128));
    }
    return writeFile(name, bytes).filename().string();
}

std::string gzip(std::string_view text) {
    std::string packed(text.size() + 200, '\0');
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

Scene loadText(const std::string& text, bool strict) {
    SceneConventions conventions;
    conventions.strict = strict;
    return loadPbrt(writeFile("scene.pbrt", text), conventions);
}

Scene loadV4(std::string_view world) {
    return loadText(std::string(kBeginV4) + std::string(world));
}

Scene loadV3(std::string_view world) {
    return loadText(std::string(kBeginV3) + std::string(world));
}

Material materialV4(std::string_view statement) {
    const Scene scene = loadV4(std::string(statement) + "\n" + kTriangle);
    return scene.materials.at(scene.triangles.at(0).material);
}

Material materialV3(std::string_view statement) {
    const Scene scene = loadV3(std::string(statement) + "\n" + kTriangle);
    return scene.materials.at(scene.triangles.at(0).material);
}

std::string problemOf(const std::string& text) {
    try {
        loadText(text, true);
    } catch (const SceneError& error) {
        std::string message = error.what();
        constexpr std::string_view kReason = " (an error because of --strict)";
        if (message.ends_with(kReason)) message.resize(message.size() - kReason.size());
        const std::string file = writeFile("scene.pbrt", text).string();
        return message.starts_with(file + ":") ? message.substr(file.size() + 1) : message;
    }
    return "";
}

std::string problemInV4(std::string_view world) {
    return problemOf(std::string(kBeginV4) + std::string(world));
}

std::vector<std::string> forgivenIn(const std::string& text) {
    return loadText(text).report.forgiven;
}

} // namespace stromboli::test

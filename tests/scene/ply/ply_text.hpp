#pragma once

#include "host/core/error.hpp"
#include "scene/ply/load_ply.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

namespace stromboli::test {

/// Loads bytes as if they were a file, p.ply.
inline Scene loadPlyBytes(const std::string& bytes, const SceneConventions& conventions = {}) {
    // One folder for all of them: mutations load thousands.
    static const struct Folder {
        std::filesystem::path path =
            std::filesystem::path(testing::TempDir()) / fmt::format("stromboli_ply_{}", getpid());
        Folder() { std::filesystem::create_directories(path); }
        ~Folder() { std::filesystem::remove_all(path); }
    } folder;
    // ext4 writes a file out at once that replaces the content of another one.
    std::filesystem::remove(folder.path / "p.ply");
    std::ofstream(folder.path / "p.ply", std::ios::binary) << bytes;
    return loadPly(folder.path / "p.ply", conventions);
}

/// The message with which a file is refused, from its name on.
inline std::string plyErrorOf(const std::string& bytes) {
    try {
        loadPlyBytes(bytes);
    } catch (const SceneError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos);
        return message.substr(message.find("p.ply"));
    }
    return "no error";
}

/// A number as a binary file has it.
template <typename T>
std::string plyBytes(T value, bool bigEndian) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (bigEndian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// A header with a format, four vertices of x, y, z (and what `more` states) and faces.
inline std::string
plyHeader(const std::string& format, const std::string& more = "",
          const std::string& faces = "element face 1\nproperty list uchar int vertex_indices\n") {
    return "ply\nformat " + format +
           " 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
           "property float z\n" +
           more + faces + "end_header\n";
}

inline const std::string kPlySquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

} // namespace stromboli::test

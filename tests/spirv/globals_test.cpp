// No shader has a mutable global variable: what a function reads and changes is in its signature.
#include "tests/spirv/modules.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

namespace stromboli::test {
namespace {

Words wordsOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    Words words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
    return words;
}

/// Names of the variables that live for as long as an invocation: storage class Private.
std::set<std::string> mutableGlobals(const Words& module) {
    constexpr uint32_t kName = 5, kVariable = 59, kPrivate = 6, kHeader = 5;
    std::map<uint32_t, std::string> names;
    std::set<std::string> found;
    for (size_t i = kHeader; i < module.size(); i += module[i] >> 16) {
        const uint32_t opcode = module[i] & 0xFFFF;
        if (opcode == kName) names[module[i + 1]] = reinterpret_cast<const char*>(&module[i + 2]);
        if (opcode == kVariable && module[i + 3] == kPrivate) found.insert(names[module[i + 2]]);
    }
    return found;
}

/// As the compiler of GLSL leaves them: later passes make such variables local where they can.
TEST(Shaders, HaveNoMutableGlobals) {
    size_t modules = 0;
    for (const auto& entry : std::filesystem::directory_iterator(STROMBOLI_SHADER_MODULES)) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with(".compiled.spv")) continue;
        ++modules;
        EXPECT_EQ(mutableGlobals(wordsOf(entry.path())), std::set<std::string>()) << name;
    }
    EXPECT_EQ(modules, 16u) << "in " STROMBOLI_SHADER_MODULES;
}

} // namespace
} // namespace stromboli::test

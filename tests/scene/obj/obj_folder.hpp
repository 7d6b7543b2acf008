#pragma once

#include "host/core/error.hpp"
#include "scene/obj/load_obj.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace stromboli::test {

/// A folder with an OBJ file and what it names.
class ObjFolder {
  public:
    ObjFolder() {
        static int number = 0;
        path_ = std::filesystem::path(testing::TempDir()) /
                fmt::format("stromboli_obj_{}_{}", getpid(), ++number);
        std::filesystem::create_directories(path_);
    }
    ~ObjFolder() { std::filesystem::remove_all(path_); }
    ObjFolder(const ObjFolder&) = delete;
    ObjFolder& operator=(const ObjFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    void write(const std::string& name, const std::string& bytes) const {
        // ext4 writes a file out at once that replaces the content of another one.
        std::filesystem::remove(path_ / name);
        std::ofstream(path_ / name, std::ios::binary) << bytes;
    }
    Scene load(const std::string& text, const SceneConventions& conventions = {}) const {
        write("a.obj", text);
        return loadObj(path_ / "a.obj", conventions);
    }

  private:
    std::filesystem::path path_;
};

inline Scene loadObjText(const std::string& text, const SceneConventions& conventions = {}) {
    return ObjFolder().load(text, conventions);
}

/// The message with which a file is refused, from its name on.
inline std::string objErrorOf(const std::string& text) {
    try {
        loadObjText(text);
    } catch (const SceneError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos);
        return message.substr(message.find("a.obj"));
    }
    return "no error";
}

} // namespace stromboli::test

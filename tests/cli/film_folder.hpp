#pragma once

#include "host/film/image_file.hpp"
#include "tests/cli/program.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace stromboli::test {

using Strings = std::vector<std::string>;

inline Strings operator+(Strings a, const Strings& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Films and the pictures they are merged to, in a folder of the test's own.
class FilmFolder : public testing::Test {
  protected:
    ScratchFolder folder;

    void run(const Strings& words) const {
        const ProgramRun program = stromboli(words);
        EXPECT_EQ(program.exitCode, 0) << program.err;
    }
    ProgramRun merge(const std::string& output, const Strings& films,
                     const Strings& extra = {}) const {
        return stromboli(Strings{"merge", "-o", folder.file(output)} + extra + films);
    }
    std::string bytesOf(const std::string& name) const {
        std::ifstream file(folder.path() / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    /// "none": the picture has no such note.
    std::string note(const std::string& picture, const std::string& name) const {
        for (const PictureNote& note : readPictureNotes(folder.path() / picture))
            if (note.name == name) return note.text;
        return "none";
    }
};

} // namespace stromboli::test

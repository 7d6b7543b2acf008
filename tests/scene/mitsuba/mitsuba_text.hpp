#pragma once

#include "host/core/error.hpp"
#include "scene/mitsuba/load_mitsuba.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::test {

/// Writes a file into a folder of this process's own, and says where it is.
std::filesystem::path writeFile(const std::string& name, std::string_view text);

/// Writes a picture of 8 bits, row after row from the top, red, green, blue and alpha. Returns its
/// name, in the folder of the scenes.
std::string writePicture(const std::string& name, int width, int height,
                         const std::vector<std::array<unsigned char, 4>>& texels);

/// `<scene version="3.0.0">`, what is given, and its end, each on a line of its own.
std::string sceneText(std::string_view inside, std::string_view version = "3.0.0");

/// A rectangle with what is given inside.
inline std::string rectangleOf(const std::string& inside) {
    return "<shape type=\"rectangle\">" + inside + "</shape>";
}

/// Loads a scene of such a text.
Scene loadText(const std::string& text, const std::vector<Definition>& definitions = {});
Scene loadInside(std::string_view inside);

/// Loads the text as a file of Mitsuba 0.6.
Scene loadOld(std::string_view inside);

/// What strict loading says is wrong, from the line's number on; empty: nothing is.
std::string problemOf(const std::string& text, const std::vector<Definition>& definitions = {});
std::string problemInside(std::string_view inside);
std::string problemInOld(std::string_view inside);

} // namespace stromboli::test

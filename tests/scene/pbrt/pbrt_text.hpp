#pragma once

#include "host/core/error.hpp"
#include "scene/pbrt/load_pbrt.hpp"

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

/// Writes a picture of 8 bits, row after row from the top. Returns its name, in that folder.
std::string writePicture(const std::string& name, int width, int height,
                         const std::vector<std::array<unsigned char, 3>>& texels);
/// A Radiance picture, row after row from the top, of powers of two.
std::string writeLight(const std::string& name, int width, int height,
                       const std::vector<std::array<float, 3>>& texels);

/// The bytes packed by gzip.
std::string gzip(std::string_view text);

/// Loads a scene of such a text.
Scene loadText(const std::string& text, bool strict = false);
/// Loads what stands in the world; a Film tells the version.
Scene loadV4(std::string_view world);
Scene loadV3(std::string_view world);
/// The material of the first triangle of a mesh that has it.
Material materialV4(std::string_view statement);
Material materialV3(std::string_view statement);
/// A triangle of the points (0, 0, 0), (1, 0, 0) and (0, 1, 0).
extern const char* const kTriangle;

/// What strict loading says is wrong, from the line's number on; empty: nothing is.
std::string problemOf(const std::string& text);
/// Loads what stands in a world of pbrt-v4, whose first line is 1.
std::string problemInV4(std::string_view world);
/// What forgiving loading says, one line each.
std::vector<std::string> forgivenIn(const std::string& text);

} // namespace stromboli::test

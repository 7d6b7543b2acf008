#pragma once

#include "scene/build/report.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace stromboli::gltf {

/// What a URI of a file stands for: the bytes of a data URI (`data:...;base64,...`), or of a file
/// in the folder `folder` or below it, found as build::companion finds files; the report says where
/// a URI had to be read otherwise than it is written. No other file is ever read: throws
/// SceneError, at `place`, where only such a one is named, by another scheme, an absolute path,
/// "..", also percent-encoded, or a symbolic link to a place outside.
std::string readUri(const std::filesystem::path& folder, std::string_view uri,
                    const build::FilePlace& place, build::Report& report);

/// A URI for messages: data URIs without their data.
std::string shortUri(std::string_view uri);

} // namespace stromboli::gltf

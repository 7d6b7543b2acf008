#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stromboli::gltf {

/// What a URI of a file stands for: the bytes of a data URI (`data:...;base64,...`), or of a file
/// in the folder `folder` or below it. Throws SceneError, with `file` and `element`, for whatever
/// leads out of the folder: other schemes, absolute paths, "..", also percent-encoded, and symbolic
/// links to a place outside.
std::string readUri(const std::filesystem::path& folder, std::string_view uri,
                    const std::string& file, const std::string& element);

/// A URI for messages: data URIs without their data.
std::string shortUri(std::string_view uri);

} // namespace stromboli::gltf

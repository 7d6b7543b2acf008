#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stromboli::gltf {

/// The two parts of a file, as views of its bytes.
struct Container {
    std::string_view json;
    std::optional<std::string_view> binary; ///< the first buffer, of .glb files that have it
    std::string problem; ///< with the length that the header states; empty: there is none
};

/// Takes a binary file (.glb) apart; one that does not begin as such is JSON as a whole. Throws
/// SceneError if chunks do not fit in the file or the JSON is not the first one.
Container openContainer(const std::string& file, std::string_view bytes);

/// True if bytes begin as those of a binary file.
bool isBinaryContainer(std::string_view bytes);

} // namespace stromboli::gltf

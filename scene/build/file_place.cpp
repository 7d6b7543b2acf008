#include "scene/build/file_place.hpp"

#include "host/core/error.hpp"

namespace stromboli::build {

std::string FilePlace::describe(const std::string& message) const {
    return SceneError(file, line, element, message).what();
}

void FilePlace::fail(const std::string& message) const {
    throw SceneError(file, line, element, message);
}

} // namespace stromboli::build

#include "host/core/error.hpp"
#include "scene/assimp/load_assimp.hpp"

namespace stromboli {

Scene loadWithAssimp(const std::filesystem::path& file, const SceneConventions&) {
    throw SceneError(file.string(), 0, "",
                     "is in a format that Assimp reads, and this program was built without its "
                     "headers; on Debian: apt install libassimp-dev, and build again");
}

} // namespace stromboli

#include "scene/ply/load_ply.hpp"

#include "host/core/error.hpp"
#include "scene/ply/ply_reader.hpp"

#include <new>

namespace stromboli {

Scene loadPly(const std::filesystem::path& file, const SceneConventions& conventions) {
    return loadPlyWith({}, file, conventions);
}

Scene loadPlyWith(const PlyAttribute& colors, const std::filesystem::path& file,
                  const SceneConventions& conventions) try {
    build::SceneBuilder builder(file.string(), conventions);
    ply::PlyReader(file, builder, colors).read();
    return builder.finish();
} catch (const std::bad_alloc&) {
    throw SceneError(file.string(), 0, "", "does not fit in memory");
}

bool looksLikePly(std::string_view beginning) {
    return beginning.starts_with("ply\n") || beginning.starts_with("ply\r");
}

} // namespace stromboli

#include "scene/ply/load_ply.hpp"

#include "host/core/error.hpp"
#include "scene/build/gunzip.hpp"
#include "scene/build/read_file.hpp"
#include "scene/ply/header.hpp"
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

uint64_t facesOfPly(const std::filesystem::path& file) {
    const std::string name = file.string();
    const std::string bytes = build::gunzipped(build::readFile(file), name);
    build::Report said; // and said already where the file is loaded
    const ply::Header header = ply::readHeader(name, bytes, said);
    const ply::Element* faces = header.find("face");
    return faces ? faces->count : 0;
}

bool looksLikePly(std::string_view beginning) {
    return beginning.starts_with("ply\n") || beginning.starts_with("ply\r");
}

} // namespace stromboli

#include "scene/obj/load_obj.hpp"

#include "host/core/error.hpp"
#include "scene/obj/obj_reader.hpp"
#include "scene/obj/statements.hpp"

#include <new>

namespace stromboli {

Scene loadObj(const std::filesystem::path& file, const SceneConventions& conventions) try {
    build::SceneBuilder builder(file.string(), conventions);
    obj::ObjReader(file, builder).read();
    return builder.finish();
} catch (const std::bad_alloc&) {
    throw SceneError(file.string(), 0, "", "does not fit in memory");
}

bool looksLikeObj(std::string_view beginning) {
    // The last line may be cut.
    const size_t end = beginning.find_last_of("\r\n");
    if (end == std::string_view::npos) return false;
    obj::Statements statements("", std::string(beginning.substr(0, end)));
    bool hasVertex = false;
    while (statements.next()) {
        if (!obj::isObjKeyword(statements.keyword())) return false;
        hasVertex = hasVertex || statements.keyword() == "v";
    }
    return hasVertex;
}

} // namespace stromboli

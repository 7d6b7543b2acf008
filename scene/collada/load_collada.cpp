#include "scene/collada/load_collada.hpp"

#include "host/core/error.hpp"
#include "scene/collada/visual_scene.hpp"

#include <new>

namespace stromboli {

Scene loadCollada(const std::filesystem::path& file, const SceneConventions& conventions) try {
    build::SceneBuilder builder(file.string(), conventions);
    const collada::Document document(file, builder.report());
    if (document.cglDialect()) builder.markCglDialect();
    collada::Context context{document, builder};
    collada::readVisualScene(context);
    return builder.finish();
} catch (const std::bad_alloc&) {
    throw SceneError(file.string(), 0, "", "does not fit in memory");
}

} // namespace stromboli

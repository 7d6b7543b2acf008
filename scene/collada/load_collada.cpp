#include "scene/collada/load_collada.hpp"

#include "host/core/error.hpp"
#include "scene/collada/visual_scene.hpp"
#include "scene/model/area_lights.hpp"

#include <new>

namespace stromboli {

Scene loadCollada(const std::filesystem::path& file, const LoadOptions& options) try {
    const collada::Document document(file);
    Scene scene;
    scene.file = file.string();
    scene.cglDialect = document.cglDialect();
    collada::Report report;
    collada::Context context{document, options, scene, report};
    collada::readVisualScene(context);
    report.writeTo(scene.report);
    // The CS184 renderer samples the rectangle and sees the mesh in its place.
    if (!options.cs184) resolveAreaLights(scene);
    return scene;
} catch (const std::bad_alloc&) {
    throw SceneError(file.string(), 0, "", "does not fit in memory");
}

} // namespace stromboli

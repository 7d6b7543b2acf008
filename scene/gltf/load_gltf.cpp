#include "scene/gltf/load_gltf.hpp"

#include "host/core/error.hpp"
#include "scene/gltf/animation.hpp"
#include "scene/gltf/materials.hpp"
#include "scene/gltf/nodes.hpp"

#include <new>

namespace stromboli {

Scene loadGltf(const std::filesystem::path& file, const SceneConventions& conventions) try {
    build::SceneBuilder builder(file.string(), conventions);
    const gltf::Document document(file, builder.report(), conventions.kept.get());
    gltf::reportExtensions(document, builder.report());
    gltf::Context context{document, builder, gltf::chosenVariant(document, builder)};
    gltf::Nodes(context).place();
    Scene scene = builder.finish();
    scene.variants = gltf::variantNames(document);
    scene.animationSeconds = gltf::animationEnd(document);
    return scene;
} catch (const std::bad_alloc&) {
    throw SceneError(file.string(), 0, "", "does not fit in memory");
}

bool looksLikeGltf(std::string_view beginning) {
    const size_t first = beginning.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    return first != std::string_view::npos && beginning[first] == '{' &&
           beginning.find("\"asset\"") != std::string_view::npos;
}

bool looksLikeBinaryGltf(std::string_view beginning) {
    return gltf::isBinaryContainer(beginning);
}

} // namespace stromboli

#include "scene/mitsuba/load_mitsuba.hpp"

#include "host/core/error.hpp"
#include "scene/build/tolerate.hpp"
#include "scene/mitsuba/emitters.hpp"
#include "scene/mitsuba/environment_map.hpp"
#include "scene/mitsuba/integrator.hpp"
#include "scene/mitsuba/sensors.hpp"
#include "scene/mitsuba/shapes.hpp"
#include "scene/xml/root_element.hpp"

#include <new>
#include <set>

namespace stromboli {
namespace mitsuba {
namespace {

/// The environment decides how the world is turned.
void turnWorld(Context& context, const Plugin& scene) {
    for (const Plugin* emitter : scene.childrenOf("emitter")) {
        if (!isEnvironment(*emitter)) continue;
        if (context.environment) {
            emitter->replace(build::Shortfall::Node,
                             "is the second environment of the scene, expected one");
            continue;
        }
        context.environment = emitter;
        if (emitter->type != "constant")
            build::tolerate(context.report(), build::Shortfall::Parameter,
                            [&] { context.worldFromFile = worldFromFileOf(*emitter); });
    }
}

/// The lamps that shapes have, and shapes within these.
void collectLampsOf(const Plugin& holder, std::set<const Plugin*>& lamps) {
    for (const Plugin::Child& child : holder.children()) {
        if (!child.plugin || child.plugin->tag != "shape") continue;
        for (const Plugin::Child& inside : child.plugin->children())
            if (inside.plugin && inside.plugin->tag == "emitter") lamps.insert(inside.plugin);
        if (child.plugin->type != "instance") collectLampsOf(*child.plugin, lamps);
    }
}

void readScene(Context& context) {
    const Plugin& scene = context.document.scene();
    turnWorld(context, scene);
    std::set<const Plugin*> lamps;
    collectLampsOf(scene, lamps);
    for (const Plugin* emitter : scene.childrenOf("emitter"))
        if (!lamps.contains(emitter)) // which may stand in the scene for shapes to refer to
            build::tolerate(context.report(), build::Shortfall::Node,
                            [&] { placeEmitter(context, *emitter); });
    bool isFirst = true;
    Shapes shapes(context);
    for (const Plugin* sensor : scene.childrenOf("sensor"))
        if (build::tolerate(context.report(), build::Shortfall::Node,
                            [&] { placeSensor(context, shapes.media(), *sensor, isFirst); }))
            isFirst = false;
    if (const Plugin* integrator = scene.onlyChildOf("integrator"))
        build::tolerate(context.report(), build::Shortfall::Node,
                        [&] { readIntegrator(context, *integrator); });
    for (const Plugin* shape : scene.childrenOf("shape"))
        build::tolerate(context.report(), build::Shortfall::Geometry,
                        [&] { shapes.place(*shape); });
    // What shapes refer to, or may.
    for (const char* tag : {"bsdf", "texture", "spectrum", "sampler", "film", "rfilter", "medium",
                            "volume", "phase", "subsurface"})
        (void)scene.childrenOf(tag);
    scene.requireAllRead();
}

} // namespace
} // namespace mitsuba

Scene loadMitsuba(const std::filesystem::path& file, const SceneConventions& conventions) try {
    build::SceneBuilder builder(file.string(), conventions);
    const mitsuba::Document document(file, conventions.selection.definitions, builder.report());
    mitsuba::Context context{document, builder};
    mitsuba::readScene(context);
    return builder.finish();
} catch (const std::bad_alloc&) {
    throw SceneError(file.string(), 0, "", "does not fit in memory");
}

bool looksLikeMitsuba(std::string_view beginning) {
    return xml::hasRootElement(beginning, "scene");
}

} // namespace stromboli

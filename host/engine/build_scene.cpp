#include "host/engine/build_scene.hpp"

#include "host/core/system.hpp"

#include <fmt/format.h>

namespace stromboli {

BuiltScene buildScene(const Scene& scene, const Estimator& estimator, const Listener& listener,
                      KeptParts* kept, uint64_t gatheredRows) {
    listener.doing(Stage::Building,
                   fmt::format("building the BVH of {} triangles", scene.triangles.size()));
    const Stopwatch watch;
    BuiltScene built;
    built.gpu =
        packScene(scene, buildWideBvh(scene, {}, kept ? &kept->trees : nullptr),
                  lightSelection(estimator), kept ? kept->environment : nullptr, gatheredRows);
    if (kept) kept->environment = built.gpu.lights.environment;
    built.seconds = watch.seconds();
    listener.doing(Stage::Preparing, "opening the device and compiling the kernel"); // comes next
    return built;
}

} // namespace stromboli

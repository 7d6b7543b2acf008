#include "host/engine/load_scene.hpp"

#include "host/checkpoint/scene_identity.hpp"
#include "host/core/error.hpp"
#include "host/core/system.hpp"
#include "host/kernel/arriving_light.hpp"
#include "host/kernel/cast_shadows.hpp"
#include "host/kernel/feelers.hpp"
#include "host/kernel/find_occluders.hpp"
#include "host/kernel/find_portals.hpp"
#include "host/kernel/glass_before_lights.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/light_notes.hpp"
#include "scene/find_scene.hpp"
#include "scene/model/default_light.hpp"
#include "scene/read_scene.hpp"

#include <fmt/format.h>

#include <utility>

namespace stromboli {

// --- Loading -------------------------------------------------------------------------------------

namespace {

/// What is around the scene, with what it was made for where nobody says another thing.
EnvironmentRequest environmentOf(const SceneRequest& request) {
    EnvironmentRequest environment = request.environment;
    if (!environment.isGiven() && request.reading.defaultLight)
        environment.file = usualEnvironment(request.source);
    environment.largestSide = request.reading.selection.largestTexture;
    environment.strict = request.reading.strict;
    return environment;
}

Scene readFile(const SceneRequest& request, const Listener& listener) {
    listener.doing(Stage::Loading, "loading " + request.source);
    SceneConventions reading = request.reading;
    if (environmentOf(request).isGiven()) reading.defaultLight = false;
    return readScene(request.source, reading);
}

/// All moments of an animation have the same floor: that of the scene without a pose of it.
std::optional<Bounds> boundsAtRest(const SceneRequest& request) {
    if (!request.ground.isGiven || !request.reading.selection.seconds) return {};
    SceneConventions reading = request.reading;
    reading.selection.seconds.reset();
    reading.selection.isFrame = false;
    return readScene(request.source, reading).bounds();
}

GroundRequest under(const std::optional<Bounds>& bounds, GroundRequest ground) {
    if (bounds) ground.under = bounds;
    return ground;
}

/// Turns the file's own environment. Returns what its rotation was.
float turnOwnEnvironment(Scene& scene, const SceneRequest& request) {
    if (environmentOf(request).isGiven()) return 0;
    if (scene.environment) {
        const float before = scene.environment->rotation;
        scene.environment->rotation = rotationOf(request.environment, before);
        if (scene.environment->isConstant() && request.environment.rotationDegrees != 0)
            scene.report.ignored.emplace_back("--env-rotate: the environment of the file is the "
                                              "same all around");
        return before;
    }
    if (request.environment.rotationDegrees != 0)
        throw UsageError(fmt::format("--env-rotate turns an environment, and {} has none: --env "
                                     "puts one around it",
                                     request.source));
    return 0;
}

/// A file of which nothing can be seen is an error, whatever its format. A moment of an animation
/// may show nothing.
void requireSomethingToDraw(const Scene& scene, const SceneRequest& request) {
    if (hasSomethingToDraw(scene) || request.reading.selection.seconds) return;
    const size_t leftOut = scene.report.warnings.size() + scene.report.forgiven.size();
    throw SceneError(
        request.source, 0, "",
        fmt::format("has nothing to draw: expected surfaces, or else a sky around them "
                    "(--env FILE){}",
                    leftOut > 0 ? "; the lines above say what was left out" : ""));
}

void report(const LoadReport& lines, const Listener& listener) {
    for (const std::string& line : lines.warnings)
        listener.warn(line);
    for (const std::string& line : lines.forgiven)
        listener.warn(line);
    for (const std::string& line : lines.ignored)
        listener.info(fmt::format("ignored: {}", line));
    for (const std::string& line : lines.assumed)
        listener.info(line);
}

} // namespace

LoadedScene loadScene(const SceneRequest& request, const Listener& listener) {
    const Stopwatch watch;
    auto scene = std::make_shared<Scene>(readFile(request, listener));
    if (const EnvironmentRequest environment = environmentOf(request); environment.isGiven()) {
        addEnvironment(*scene, environment);
        if (!request.environment.isGiven())
            listener.info(fmt::format("{} is lit by the bundled {}, for which it was made",
                                      request.source, environment.file));
    }
    const float rotationOfFile = turnOwnEnvironment(*scene, request);
    const std::optional<Bounds> atRest = boundsAtRest(request);
    takePortals(*scene, request.portals);
    if (request.ground.isGiven) addGround(*scene, under(atRest, request.ground));
    if (request.fog.isGiven()) addFog(*scene, request.fog);
    const double seconds = watch.seconds();
    report(scene->report, listener);
    requireSomethingToDraw(*scene, request);
    return {std::move(scene), seconds, atRest, rotationOfFile};
}

LoadedScene loadMoment(const SceneRequest& request, LoadedScene before, const Listener& listener) {
    const Stopwatch watch;
    Scene moment = readFile(request, listener);
    const double seconds = watch.seconds();
    if (!moment.isMoment()) {
        before.scene->cameras = std::move(moment.cameras);
        return {before.scene, seconds, before.atRest, before.rotationOfFile};
    }
    const float rotationOfFile = turnOwnEnvironment(moment, request);
    if (request.environment.isGiven())
        addEnvironment(moment, std::move(*std::exchange(before.scene->environment, {})));
    takePortals(moment, request.portals);
    if (request.ground.isGiven) addGround(moment, under(before.atRest, request.ground));
    if (request.fog.isGiven()) addFog(moment, request.fog);
    return {std::make_shared<Scene>(std::move(moment)), seconds, before.atRest, rotationOfFile};
}

// --- Building ------------------------------------------------------------------------------------

BuiltScene buildScene(const Scene& scene, const Estimator& estimator, const Listener& listener,
                      KeptParts* kept, uint64_t gatheredRows, const GpuScene* before) {
    listener.doing(Stage::Building,
                   fmt::format("building the BVH of {} triangles", scene.triangles.size()));
    const Stopwatch watch;
    BuiltScene built;
    if (kept) {
        const uint32_t environment =
            scene.environment ? environmentIdentity(*scene.environment) : 0;
        if (std::exchange(kept->environmentIdentity, environment) != environment)
            kept->environment = nullptr;
    }
    built.gpu = packScene(scene, buildWideBvh(scene, {}, kept ? &kept->trees : nullptr),
                          lightSelection(estimator), kept ? kept->environment : nullptr,
                          gatheredRows, before);
    if (kept) kept->environment = built.gpu.lights.environment;
    const auto decideAs = [&](const auto& first) {
        built.gpu.ofRay = first.ofRay;
        built.gpu.looksAtOccluders = first.looksAtOccluders;
        built.gpu.looksAtShadowMap = first.looksAtShadowMap;
    };
    if (kept) decideAs(*kept);
    if (before) decideAs(*before);
    built.seconds = watch.seconds();
    listener.doing(Stage::Preparing, "opening the device and compiling the kernel"); // comes next
    return built;
}

namespace {

void lookForOccluders(GpuScene& built, const Scene& scene, const Camera& camera) {
    if (!built.ofRay.isKnown()) return; // the camera sees nothing
    if (!built.looksAtOccluders) {
        built.occluders = occludersThatPay(scene, built, camera);
        built.looksAtOccluders = !built.occluders.all.empty();
    } else if (*built.looksAtOccluders) {
        built.occluders = findOccluders(scene, built, camera);
    }
}

void lookForShadows(GpuScene& built, const Scene& scene, const Camera& camera) {
    if (!built.ofRay.isKnown()) return;
    if (!built.looksAtShadowMap) {
        built.shadowMap = shadowsThatPay(scene, built, camera);
        built.looksAtShadowMap = built.shadowMap.has_value();
    } else if (*built.looksAtShadowMap) {
        built.shadowMap = castShadows(scene, built, camera);
    }
}

} // namespace

std::vector<uint32_t> fitToPicture(GpuScene& built, const Scene& scene, const Camera& camera,
                                   const Estimator& estimator) {
    if (!built.ofRay.isKnown()) built.ofRay = visitsOfRay(built.bvh, camera);
    if (!built.lit && mayAimBounces(estimator)) built.lit = findLitCells(built);
    built.glassBeforeLights =
        mayLightThroughGlass(built, estimator) ? shareThroughGlass(scene, built, camera) : 0;
    const bool goThroughGlass = lightsThroughGlass(built, estimator);
    built.portals = {};
    if (aimsAtPortals(built, estimator)) {
        const std::shared_ptr<const EnvironmentTable>& sky = built.lights.environment;
        built.portals = scene.portals.empty()
                            ? findPortals(built.bvh, camera, sky ? sky->unevenness : 1,
                                          goThroughGlass ? clearGlassOf(built) : SeesThrough())
                            : statedPortals(scene.portals, camera);
    }
    built.guide.reset();
    if (mayGuideLight(built, estimator) && built.portals.all.empty())
        built.guide = guideThatPays(scene, built, camera, goThroughGlass);
    built.occluders = {};
    if (mayLookAtOccluders(built, estimator)) lookForOccluders(built, scene, camera);
    built.shadowMap.reset();
    if (mayLookAtShadowMap(built, estimator)) lookForShadows(built, scene, camera);
    if (!built.lights.weighed) return {};
    HowLightsArePicked how{built.lights.weighed->plain};
    if (samplesLights(estimator.directLight) && estimator.integrator == Integrator::Path)
        how = howToPick(scene, built, camera, goThroughGlass);
    if (!pickBy(built.lights, how)) return {};
    return {BINDING_LIGHT_TABLE};
}

} // namespace stromboli

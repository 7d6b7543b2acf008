#pragma once

#include "host/bvh/two_level_layout.hpp"
#include "host/core/messages.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/render/estimator.hpp"
#include "scene/add_environment.hpp"
#include "scene/add_fog.hpp"
#include "scene/add_ground.hpp"
#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"
#include "scene/named_portals.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

// --- Listeners -----------------------------------------------------------------------------------

/// What an engine is busy with.
enum class Stage { Loading, Building, Preparing, Sampling, Looking, Writing };

/// Whom the engine tells what it does. Functions may be empty. They are called on the threads that
/// call the engine, and never after that call has returned; but messages about a device, of its
/// cache and of Vulkan's validation layer, come on any thread, from its opening to its end.
struct Listener {
    Messages message;
    /// What begins now, in words: "building the BVH of 12 triangles".
    std::function<void(Stage, const std::string&)> activity;

    void detail(const std::string& text) const { tell(message, Severity::Detail, text); }
    void info(const std::string& text) const { tell(message, Severity::Information, text); }
    void warn(const std::string& text) const { tell(message, Severity::Warning, text); }
    void doing(Stage stage, const std::string& what) const {
        if (activity) activity(stage, what);
    }
};

// --- Loading -------------------------------------------------------------------------------------

/// Where a scene comes from, how its file is read, what lights it from all around and what fills
/// it.
struct SceneRequest {
    std::string source; ///< a file, a bundled scene or a generated one (scene/read_scene.hpp)
    SceneConventions reading;
    EnvironmentRequest environment;
    GroundRequest ground;
    FogRequest fog;
    std::vector<std::string> portals; ///< objects that are openings (scene/named_portals.hpp)
};

/// A scene in memory. Sessions share it and do not change it; nor may others while one uses it.
struct LoadedScene {
    std::shared_ptr<Scene> scene;
    double seconds = 0;                ///< that reading took
    std::optional<Bounds> atRest = {}; ///< of an animation with a floor: without a pose of it
    /// Environment::rotation of the file's own environment, before the request turns it; of any
    /// other one 0 (rotationOf()).
    float rotationOfFile = 0;
};

/// Reads or makes the scene, and reports what of its file was ignored, forgiven or assumed. Throws
/// SceneError.
LoadedScene loadScene(const SceneRequest& request, const Listener& listener = {});

/// Another moment of the file that `before` was loaded from, without a report. Where nothing but
/// cameras moves, it is the scene of `before` with its cameras as they are then, so that sessions
/// keep what they have built of it. Else the environment, which no moment changes, is taken out of
/// `before`, which is of no use any more.
LoadedScene loadMoment(const SceneRequest& request, LoadedScene before,
                       const Listener& listener = {});

// --- Building ------------------------------------------------------------------------------------

/// A BVH and the kernel's arrays.
struct BuiltScene {
    GpuScene gpu;
    double seconds = 0; ///< that building took
};

/// What one moment of an animation, or one place of objects that a session moves, keeps for the
/// next.
struct KeptParts {
    KeptTrees trees;
    std::shared_ptr<const EnvironmentTable> environment;
    uint32_t environmentIdentity = 0;     ///< environmentIdentity() of what it was made from
    VisitsOfRay ofRay;                    ///< GpuScene::ofRay of the first moment
    std::optional<bool> looksAtOccluders; ///< likewise
    std::optional<bool> looksAtShadowMap; ///< likewise
};

/// kept: where the scene is a moment of a sequence. gatheredRows, before: as packScene() has them.
BuiltScene buildScene(const Scene& scene, const Estimator& estimator, const Listener& listener = {},
                      KeptParts* kept = nullptr, uint64_t gatheredRows = kUsualGatheredRows,
                      const GpuScene* before = nullptr);

/// Brings into the kernel's arrays of `scene` what follows from the picture to come.
/// GpuScene::portals: those of the scene, or else those that are found for what this camera sees;
/// none where light samples go to no sky, or shall aim at none. GpuScene::ofRay, unless it
/// is known: pictures of other cameras keep it, and the kernel with it. GpuScene::guide: where
/// light samples may be guided and that pays (guideThatPays()). GpuScene::lights: picked by how
/// much of their light arrives (howToPick()). GpuScene::occluders and shadowMap: where they
/// pay in the first picture. Returns the bindings whose contents have changed.
std::vector<uint32_t> fitToPicture(GpuScene& built, const Scene& scene, const Camera& camera,
                                   const Estimator& estimator);

} // namespace stromboli

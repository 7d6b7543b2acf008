#pragma once

#include "host/core/text.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/engine/background.hpp"
#include "host/engine/load_scene.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/layers.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

enum class BackendChoice { Vulkan, Reference };
template <>
inline constexpr auto kNamedValues<BackendChoice> = std::to_array<NamedValue<BackendChoice>>({
    {BackendChoice::Vulkan, "vulkan", "the kernel, on a Vulkan device"},
    {BackendChoice::Reference, "reference", "the slow double-precision path tracer on the CPU"},
});

template <>
inline constexpr auto kNamedValues<PathScheduler> = std::to_array<NamedValue<PathScheduler>>({
    {PathScheduler::Persistent, "persistent", "one kernel, whose lanes follow paths"},
    {PathScheduler::Wavefront, "wavefront", "kernels that draw, trace and follow, with queues"},
});

/// What takes the samples. None of it changes what is estimated.
struct DeviceRequest {
    BackendChoice backend = BackendChoice::Vulkan;
    std::string device;       ///< one or several (host/vulkan/device.hpp); empty: the best
    bool maybeSeveral = true; ///< else to name several is an error
    PathScheduler scheduler = PathScheduler::Persistent;
    uint32_t threads = 0;                  ///< of the reference; 0: all
    std::optional<uint32_t> filmMebibytes; ///< for the film; empty: half of the machine's memory
    /// For the whole process, by the estimate of Renderer::memoryNeeded(); empty: no limit.
    std::optional<double> mostMebibytes;
};

/// Which pictures' light samples are guided, where that pays (docs/theory/estimator.md, "Learned
/// light samples").
enum class Guiding { Automatic, On, Off };
template <>
inline constexpr auto kNamedValues<Guiding> = std::to_array<NamedValue<Guiding>>({
    {Guiding::Automatic, "auto", "of pictures with 16 samples or more"},
    {Guiding::On, "on", "of all pictures"},
    {Guiding::Off, "off", "of none"},
});

/// Whether light samples to the sky aim at windows (docs/theory/estimator.md, "Portals").
enum class PortalUse { Automatic, On, Off };
template <>
inline constexpr auto kNamedValues<PortalUse> = std::to_array<NamedValue<PortalUse>>({
    {PortalUse::Automatic, "auto", "unless --guiding is on"},
    {PortalUse::On, "on", "in place of guiding"},
    {PortalUse::Off, "off", "at none"},
});

/// What is left to the scene's file where it asks for it (RenderHints).
struct LeftToFile {
    bool bounces = true, filter = true, integrator = true;
};

/// A picture of a scene: which one, of what, how many samples, and what is known of each pixel
/// beside its radiance.
struct RenderRequest {
    std::optional<PictureSize> size; ///< empty: defaultPictureSize()
    Crop crop;                       ///< width 0: all of it
    CameraRequest camera;
    /// In place of what `camera` says.
    std::optional<Camera> resolvedCamera;
    FramingConventions framing;
    Estimator estimator;              ///< its branches are chosen below
    std::optional<uint32_t> branches; ///< empty: what pays in the scene
    Guiding guiding = Guiding::Automatic;
    PortalUse portals = PortalUse::Automatic;
    LeftToFile leftToFile;
    PathBudget budget;
    bool transparent = false; ///< alpha in place of the environment
    /// In place of the environment, or of nothing; not of a transparent picture.
    std::optional<Background> background;
    /// The object or material that is not in the picture but for what the objects do to its light
    /// (shadow_catcher.hpp). The picture is transparent, or has a background.
    std::optional<std::string> shadowCatcher;
    std::vector<Layer> layers;
    Denoiser denoiser = Denoiser::Off;
    /// A denoised picture has the noisy one and the predicted error as channels too.
    bool keepsNoisy = false;

    /// Names of the channels beside the radiance.
    std::vector<std::string> channels() const;
};

/// The picture as it is rendered: nothing is left open.
struct ResolvedPicture {
    Camera camera;
    RenderSettings settings;
};

/// The estimator, the size and the branches that the scene and the request come to, and the camera.
/// Reports what the scene's file asks for and whose view is taken. Throws SceneError, and
/// UsageError where the crop is outside of the picture or the picture does not fit this machine's
/// memory.
ResolvedPicture resolvePicture(const Scene& scene, const RenderRequest& request,
                               const Listener& listener = {});

/// Warns of a scene without surfaces or light.
void warnOfBlackPicture(const Scene& scene, const std::string& name, const RenderRequest& request,
                        const Listener& listener);

/// The most paths that settings allow.
uint64_t mostPathsOf(const RenderSettings& settings);

} // namespace stromboli

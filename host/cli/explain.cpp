// `render --pixel`: one pixel, or one of its samples, explained.
#include "host/cli/explain.hpp"

#include "host/cli/commands.hpp"
#include "host/cli/explain_text.hpp"
#include "host/cli/log.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/engine/renderer.hpp"
#include "host/engine/shadow_catcher.hpp"
#include "host/reference/reference_backend.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace stromboli {
namespace {

constexpr uint32_t kThePixel = 0; ///< the only one of the picture's part that is rendered

/// A picture of its size, of which only the one pixel is rendered.
ResolvedPicture pictureOfPixel(ResolvedPicture picture, const PixelQuestion& asked) {
    PictureArea& area = picture.settings.area;
    if (asked.x >= area.width || asked.y >= area.height)
        throw UsageError(fmt::format("--pixel {} {} is not in the picture of {} x {}", asked.x,
                                     asked.y, area.width, area.height));
    area.crop = {asked.x, asked.y, 1, 1};
    return picture;
}

/// What is told of a sample that is no path: its value.
RecordedPath valueOnly(Backend& backend, uint32_t sample) {
    const SampleValue value = backend.sampleAlone(kThePixel, sample);
    RecordedPath path;
    path.radiance = value.radiance;
    path.rejected = value.rejected;
    return path;
}

/// The sample by the backend that was asked for, and its path by the reference if that is another.
std::vector<PathByBackend> explainSample(Renderer& renderer, const RenderOptions& options,
                                         const PreparedPicture& prepared,
                                         const ResolvedPicture& picture, uint32_t sample) {
    const bool isKernel = options.device.backend == BackendChoice::Vulkan;
    const bool isPath = picture.settings.estimator.integrator == Integrator::Path;
    const std::shared_ptr<Backend> backend = renderer.backend(picture.settings, false);
    std::vector<PathByBackend> all;
    all.push_back({isKernel ? "kernel" : "reference", isKernel, {}});
    RecordedPath& taken = all.front().path;
    auto* recorder = dynamic_cast<PathRecorder*>(backend.get());
    taken = isPath && recorder ? recorder->record(kThePixel, sample) : valueOnly(*backend, sample);
    if (!isKernel || !isPath) return all;
    const ReferenceBackend reference(*prepared.scene.scene, picture.camera, picture.settings,
                                     options.device.threads);
    if (reference.mayRetrace())
        all.push_back({"reference", false, reference.retrace(taken)});
    else
        logging::info("the reference does not follow the kernel's paths through media or by "
                      "other conventions of shading; --backend reference shows paths of its own");
    return all;
}

PixelByBackend pixelBy(Backend& backend, const std::string& name, uint32_t count) {
    PixelByBackend pixel{name, {}, backend.samplesAlone(kThePixel, 0, count)};
    for (const SampleValue& value : pixel.samples) {
        if (!value.rejected) {
            // The pixel filter's weight is in the value already, and may have made it negative.
            PixelStatistics one;
            one.count = 1;
            one.mean = value.radiance;
            pixel.statistics.merge(one);
        } else {
            ++pixel.statistics.rejected;
        }
    }
    return pixel;
}

/// Samples of the pixel: those that a render without spreading would take, but not so many that it
/// takes minutes.
uint32_t samplesOf(const RenderSettings& settings) {
    constexpr uint32_t kMost = 1u << 16;
    return std::clamp(settings.budget.mostSamplesPerPixel, 1u, kMost);
}

std::vector<PixelByBackend> explainAll(Renderer& renderer, const RenderOptions& options,
                                       const PreparedPicture& prepared,
                                       const ResolvedPicture& picture) {
    const uint32_t count = samplesOf(picture.settings);
    const bool isKernel = options.device.backend == BackendChoice::Vulkan;
    const std::shared_ptr<Backend> backend = renderer.backend(picture.settings, false);
    std::vector<PixelByBackend> all;
    all.push_back(pixelBy(*backend, isKernel ? "kernel" : "reference", count));
    if (!isKernel) return all;
    ReferenceBackend reference(*prepared.scene.scene, picture.camera, picture.settings,
                               options.device.threads);
    all.push_back(pixelBy(reference, "reference", count));
    return all;
}

} // namespace

int explainPixel(const RenderOptions& options) {
    const PixelQuestion& asked = *options.pixelAlone;
    Renderer renderer(options.device, toTerminal());
    PreparedPicture prepared = preparePicture(options);
    if (const std::optional<std::string>& catcher = options.picture.shadowCatcher) {
        requireCatcher(*prepared.scene.scene, *catcher);
        prepared.scene.scene =
            std::make_shared<Scene>(withoutCatcher(*prepared.scene.scene, *catcher));
    }
    const Scene& scene = *prepared.scene.scene;
    const ResolvedPicture picture = pictureOfPixel(prepared.picture, asked);
    renderer.begin(prepared.scene.scene, picture, 0);
    const uint32_t branches = picture.settings.estimator.branches;
    Json json = {{"pixel", {asked.x, asked.y}}, {"paths_per_sample", branches}};
    std::string text;
    if (asked.sample) {
        const std::vector<PathByBackend> all =
            explainSample(renderer, options, prepared, picture, *asked.sample);
        json["sample"] = *asked.sample;
        json.update(jsonOfPath(all, scene));
        text = textOfPath(all, scene);
    } else {
        const std::vector<PixelByBackend> all = explainAll(renderer, options, prepared, picture);
        json.update(jsonOfPixel(all));
        text =
            fmt::format("pixel {} {}: {} samples{}\n", asked.x, asked.y, all.front().samples.size(),
                        branches > 1 ? fmt::format(" of {} paths", branches) : "") +
            textOfPixel(all);
    }
    renderer.requireNoValidationMessages();
    nowDoing("printing", StatusLine::OfOthers);
    if (asked.jsonFile.empty())
        fmt::print("{}", text);
    else
        writeOutput(asked.jsonFile, json.dump(1) + "\n");
    return 0;
}

} // namespace stromboli

#pragma once

#include "host/render/backend.hpp"
#include "host/render/layers.hpp"
#include "host/render/recorded_path.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <memory>

namespace stromboli {

/// Bytes that a backend takes for a scene, beside the scene itself.
uint64_t referenceBytes(const Scene& scene);

/// Path tracer in double precision on the CPU: the second, independent implementation of
/// docs/theory/estimator.md, for checking the Vulkan kernel against. Random numbers depend on
/// pixel, sample and seed only, so the film is the same to the last bit for every number of threads
/// and every division into passes.
class ReferenceBackend final : public Backend, public Viewer, public PathRecorder {
  public:
    /// The scene must outlive the backend. threads: 0 for all the machine has, which is also the
    /// most there will be. Throws std::invalid_argument for a scene with area lights that are not
    /// resolved (scene/model/ area_lights.hpp) where emitters are sampled, and for 0 light samples.
    ReferenceBackend(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                     unsigned threads = 0);
    ~ReferenceBackend() override;

    /// The film is of settings.area; each pixel is named at most once (std::invalid_argument if one
    /// is not in it). `progress` is called from the threads at
    /// work, one at a time.
    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override;
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override;
    RecordedPath record(uint32_t pixel, uint32_t sample) override;
    /// The path that the kernel has taken, with what its directions, densities and decisions meet
    /// and bring by the reference. Throws std::invalid_argument in scenes with media, and with
    /// conventions of shading other than the default's, which it does not follow.
    RecordedPath retrace(const RecordedPath& taken) const;
    /// Whether retrace() can.
    bool mayRetrace() const;
    RenderCounters counters() const override;
    void beginAt(uint32_t firstSample) override;
    std::vector<SeenPixel> see(uint32_t first, std::span<const uint32_t> samples, Seeing what,
                               uint32_t firstSample = 0) override;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace stromboli

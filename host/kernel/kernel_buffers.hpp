#pragma once

#include "host/film/film.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/backend.hpp"
#include "host/render/estimator.hpp"
#include "host/vulkan/buffer.hpp"
#include "shaders/shared/render_types.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// --- Plans of buffers ----------------------------------------------------------------------------

/// How buffers that are read row by row are bound.
vulkan::BufferUse rowUse(const DeviceTuning& tuning);

/// The scene's buffers, in the order of their bindings.
std::vector<vulkan::BufferPlan> planSceneBuffers(const GpuScene& scene, const DeviceTuning& tuning);

/// Bytes of the largest buffer of the scene.
uint64_t largestSceneBuffer(const GpuScene& scene);
/// Bytes of the largest buffer that the path kernel reads row by row and that cannot be cut into
/// parts: of the scene, or the work list of a picture of so many pixels.
uint64_t largestRowBuffer(const GpuScene& scene, uint64_t pixels);

/// All device buffers of a scene and a picture, known before anything is allocated: the driver adds
/// no more than its alignment to each. The film may be several buffers (pixelsPerSegment).
std::vector<vulkan::BufferPlan> planBuffers(const GpuScene& scene, const PictureArea& area,
                                            const Estimator& estimator, const DeviceTuning& tuning);

/// Pixels of the film, with all their strands, that fit one buffer and one binding.
uint64_t pixelsPerSegment(const vulkan::DeviceDescription& device, const DeviceTuning& tuning);

/// Pixels of the film for which the device has memory beside the scene.
uint64_t filmPixelsThatFit(const vulkan::DeviceDescription& device, const GpuScene& scene,
                           const Estimator& estimator);

/// Whether the device has room for the scene's textures, as they were packed. Where it has not,
/// packing them plainly (gatheredRows 0) takes a quarter of the memory.
bool haveRoomForTextures(const vulkan::DeviceDescription& device, const GpuScene& scene);

/// Throws DeviceError that names what does not fit, before anything is allocated or uploaded.
void checkMemory(const vulkan::DeviceDescription& device, const GpuScene& scene,
                 const PictureArea& area, const Estimator& estimator, const DeviceTuning& tuning);

/// What a scheduler keeps of paths between two dispatches (BINDING_PATHS, BINDING_QUEUES).
struct PathBuffers {
    vulkan::BufferPlan paths;
    std::optional<vulkan::BufferPlan> queues; ///< of the wavefront scheduler
};
PathBuffers pathBuffers(const KernelFeatures& features, uint64_t lanes, PathScheduler scheduler);

// --- The scene on the device ---------------------------------------------------------------------

/// Buffers that hold what a scene has for these bindings already.
using SceneBuffers = std::map<uint32_t, vulkan::Buffer>;

/// A scene in the device's memory: uploaded once, for all pictures of it.
class DeviceScene {
  public:
    /// `scene` must outlive the object. filled: of the same device; the others are uploaded. Throws
    /// DeviceError if a buffer is over a limit of the device.
    DeviceScene(const vulkan::Device& device, const GpuScene& scene, const DeviceTuning& tuning,
                SceneBuffers filled = {});

    /// Gives away the buffers in which the next scene has the same bytes, and frees the others: the
    /// object has none after that.
    SceneBuffers releaseWhatIsAlsoIn(const GpuScene& next);
    /// Gives away all buffers but those of these bindings, which it frees: the scene has become
    /// another one there. The object has none after that.
    SceneBuffers releaseAllBut(std::span<const uint32_t> changed);

    const GpuScene& scene() const { return scene_; }
    /// How its rows are read: as DeviceTuning::texelFetch was when it was uploaded.
    bool isFetchedAsTexels() const { return isFetchedAsTexels_; }
    /// In the order of their bindings, which are the first of the kernel's.
    const std::vector<vulkan::Buffer>& buffers() const { return buffers_; }

  private:
    const GpuScene& scene_;
    bool isFetchedAsTexels_;
    std::vector<vulkan::Buffer> buffers_;
};

// --- The film on the device ----------------------------------------------------------------------

/// A run of the rendered pixels whose states fit one binding.
struct FilmSegment {
    uint32_t firstPixel; ///< counted in the part that is rendered
    uint32_t pixelCount;
    vulkan::Buffer pixels; ///< those of all strands of a pixel, then of the next
};

/// The statistics of a picture's pixels in the device's memory.
class DeviceFilm {
  public:
    /// An empty film. Throws DeviceError if it does not fit.
    DeviceFilm(const vulkan::Device& device, const PictureArea& area, const DeviceTuning& tuning);

    const PictureArea& area() const { return area_; }
    const std::vector<FilmSegment>& segments() const { return segments_; }

    /// Strands of each pixel.
    uint32_t strands() const { return strands_; }
    /// The targets as work items of each segment, in their order, with one for each strand that is
    /// to have a sample.
    std::vector<std::vector<gpu::WorkItem>> workOf(std::span<const PixelTarget> targets) const;
    /// The segment of a pixel, and the index there of its first strand's state.
    std::pair<size_t, uint32_t> firstStrandOf(uint32_t pixel) const;

    gpu::PixelState read(size_t segment, uint32_t index);
    void write(size_t segment, uint32_t index, const gpu::PixelState& state);
    /// Statistics of all pixels of a segment that are in `items`, into `film`.
    void readBack(size_t segment, std::span<const gpu::WorkItem> items, Film& film);

    /// Forgets all samples.
    void clear();

    /// Pixels to the last bit.
    KeptPixels save(PixelRun run);
    /// What was saved of these pixels; also into `film`. Throws std::invalid_argument if they are
    /// not of the area, or if their number is another.
    void restore(PixelRun run, const KeptPixels& pixels, Film& film);

  private:
    /// Pixels of a segment, counted in it; until the next dispatch or call.
    std::span<const gpu::PixelState> statesOf(const FilmSegment& segment, PixelRun run);

    PictureArea area_;
    uint32_t strands_;
    vulkan::Queue queue_;
    std::vector<FilmSegment> segments_;
    std::vector<gpu::PixelState>
        copy_; ///< of a part of a segment, where it is not the host's memory
};

} // namespace stromboli

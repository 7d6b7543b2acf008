#pragma once

#include "host/film/film.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/backend.hpp"
#include "host/vulkan/buffer.hpp"
#include "shaders/shared/render_types.h"

#include <span>
#include <vector>

namespace stromboli {

/// The statistics of a picture's pixels in the device's memory.
class DeviceFilm {
  public:
    /// A run of the rendered pixels whose states fit one binding.
    struct Segment {
        uint32_t firstPixel; ///< counted in the part that is rendered
        uint32_t pixelCount;
        vulkan::Buffer pixels;
    };

    /// An empty film. Throws DeviceError if it does not fit.
    DeviceFilm(const vulkan::Device& device, const PictureArea& area, const DeviceTuning& tuning);

    const PictureArea& area() const { return area_; }
    const std::vector<Segment>& segments() const { return segments_; }

    /// The targets as work items of each segment, in their order.
    std::vector<std::vector<gpu::WorkItem>> workOf(std::span<const PixelTarget> targets) const;
    /// The segment of a pixel, and its index there.
    std::pair<size_t, uint32_t> segmentOf(uint32_t pixel) const;

    gpu::PixelState read(size_t segment, uint32_t pixel);
    void write(size_t segment, uint32_t pixel, const gpu::PixelState& state);
    /// Statistics of all pixels of a segment that are in `items`, into `film`.
    void readBack(size_t segment, std::span<const gpu::WorkItem> items, Film& film);

    /// Forgets all samples.
    void clear();

    /// Pixels to the last bit.
    std::vector<PixelSums> save(PixelRun run);
    /// What was saved of these pixels; also into `film`. Throws std::invalid_argument if they are
    /// not of the area, or if their number is another.
    void restore(PixelRun run, std::span<const PixelSums> sums, Film& film);

  private:
    /// Pixels of a segment, counted in it; until the next dispatch or call.
    std::span<const gpu::PixelState> statesOf(const Segment& segment, PixelRun run);

    PictureArea area_;
    vulkan::Queue queue_;
    std::vector<Segment> segments_;
    std::vector<gpu::PixelState>
        copy_; ///< of a part of a segment, where it is not the host's memory
};

} // namespace stromboli

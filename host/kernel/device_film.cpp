#include "host/kernel/device_film.hpp"

#include "host/kernel/kernel_buffers.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

namespace stromboli {
namespace {

std::span<const std::byte> bytesOf(const std::vector<gpu::PixelState>& states) {
    return std::as_bytes(std::span(states));
}

PixelStatistics statisticsOf(const gpu::PixelState& s) {
    PixelStatistics p;
    p.count = s.count;
    p.rejected = s.rejected;
    if (s.rejected > 0) p.firstRejected = s.firstRejected;
    if (s.count == 0) return p;
    p.mean = (glm::dvec3(s.sum) + glm::dvec3(s.sumError)) / double(s.count);
    p.m2 = glm::dvec3(s.m2) + glm::dvec3(s.m2Error);
    return p;
}

PixelSums sumsOf(const gpu::PixelState& s) {
    return {.count = s.count,
            .rejected = s.rejected,
            .firstRejected = s.firstRejected,
            .first = s.sum,
            .firstError = s.sumError,
            .second = s.m2,
            .secondError = s.m2Error};
}

gpu::PixelState stateOf(const PixelSums& s) {
    gpu::PixelState state{};
    state.count = s.count;
    state.rejected = s.rejected;
    state.firstRejected = s.firstRejected;
    state.sum = s.first;
    state.sumError = s.firstError;
    state.m2 = s.second;
    state.m2Error = s.secondError;
    return state;
}

/// What of a run lies in a segment, counted in it.
PixelRun partOf(const DeviceFilm::Segment& segment, PixelRun run) {
    const uint32_t first = std::max(run.first, segment.firstPixel);
    const uint32_t end = std::min(run.first + run.count, segment.firstPixel + segment.pixelCount);
    if (end <= first) return {};
    return {first - segment.firstPixel, end - first};
}

} // namespace

DeviceFilm::DeviceFilm(const vulkan::Device& device, const PictureArea& area,
                       const DeviceTuning& tuning)
    : area_(area), queue_(device) {
    const uint64_t total = area.pixelCount();
    const uint64_t perSegment = pixelsPerSegment(device.description(), tuning);
    for (uint64_t first = 0; first < total; first += perSegment) {
        const auto count = uint32_t(std::min(perSegment, total - first));
        Segment& s = segments_.emplace_back(
            Segment{uint32_t(first), count,
                    vulkan::Buffer(device, "film", uint64_t(count) * sizeof(gpu::PixelState),
                                   rowUse(tuning))});
        s.pixels.clear(queue_);
    }
}

std::pair<size_t, uint32_t> DeviceFilm::segmentOf(uint32_t pixel) const {
    const uint32_t perSegment = segments_.front().pixelCount;
    return {pixel / perSegment, pixel % perSegment};
}

std::vector<std::vector<gpu::WorkItem>>
DeviceFilm::workOf(std::span<const PixelTarget> targets) const {
    std::vector<std::vector<gpu::WorkItem>> work(segments_.size());
    for (const PixelTarget& t : targets) {
        const auto [segment, pixel] = segmentOf(t.pixel);
        const PixelPlace place = area_.placeOf(t.pixel);
        work[segment].push_back({pixel, t.samples, place.x, place.y});
    }
    return work;
}

gpu::PixelState DeviceFilm::read(size_t segment, uint32_t pixel) {
    gpu::PixelState state{};
    segments_[segment].pixels.download(queue_, std::as_writable_bytes(std::span(&state, 1)),
                                       uint64_t(pixel) * sizeof(gpu::PixelState));
    return state;
}

void DeviceFilm::write(size_t segment, uint32_t pixel, const gpu::PixelState& state) {
    segments_[segment].pixels.upload(queue_, std::as_bytes(std::span(&state, 1)),
                                     uint64_t(pixel) * sizeof(gpu::PixelState));
}

std::span<const gpu::PixelState> DeviceFilm::statesOf(const Segment& segment, PixelRun run) {
    if (const std::byte* view = segment.pixels.hostView())
        return {reinterpret_cast<const gpu::PixelState*>(view) + run.first, run.count};
    copy_.resize(run.count);
    segment.pixels.download(queue_, std::as_writable_bytes(std::span(copy_)),
                            uint64_t(run.first) * sizeof(gpu::PixelState));
    return copy_;
}

void DeviceFilm::readBack(size_t index, std::span<const gpu::WorkItem> items, Film& film) {
    if (items.empty()) return;
    const Segment& segment = segments_[index];
    const auto [least, most] = std::ranges::minmax(items, {}, &gpu::WorkItem::pixel);
    const PixelRun run = {least.pixel, most.pixel - least.pixel + 1};
    const std::span<const gpu::PixelState> states = statesOf(segment, run);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, items.size(), 4096), [&](const auto& range) {
        for (size_t i = range.begin(); i != range.end(); ++i)
            film.pixels[segment.firstPixel + items[i].pixel] =
                statisticsOf(states[items[i].pixel - run.first]);
    });
}

void DeviceFilm::clear() {
    for (Segment& segment : segments_)
        segment.pixels.clear(queue_);
}

std::vector<PixelSums> DeviceFilm::save(PixelRun run) {
    std::vector<PixelSums> sums;
    sums.reserve(run.count);
    for (const Segment& segment : segments_) {
        const PixelRun part = partOf(segment, run);
        if (part.count == 0) continue;
        for (const gpu::PixelState& state : statesOf(segment, part))
            sums.push_back(sumsOf(state));
    }
    return sums;
}

void DeviceFilm::restore(PixelRun run, std::span<const PixelSums> sums, Film& film) {
    if (sums.size() != run.count || uint64_t(run.first) + run.count > area_.pixelCount())
        throw std::invalid_argument("the saved film is not of this area");
    for (Segment& segment : segments_) {
        const PixelRun part = partOf(segment, run);
        if (part.count == 0) continue;
        const uint32_t first = segment.firstPixel + part.first;
        std::vector<gpu::PixelState> states;
        for (const PixelSums& s : sums.subspan(first - run.first, part.count))
            states.push_back(stateOf(s));
        segment.pixels.upload(queue_, bytesOf(states),
                              uint64_t(part.first) * sizeof(gpu::PixelState));
        for (uint32_t i = 0; i < part.count; ++i)
            film.pixels[first + i] = statisticsOf(states[i]);
    }
}

} // namespace stromboli

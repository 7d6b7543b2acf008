#include "host/render/kept_pixels.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace stromboli {
namespace {

/// PixelStatistics without bytes that mean nothing.
struct StatisticsBytes {
    uint32_t count, rejected, firstRejected, unused;
    glm::dvec3 mean, m2;
};
static_assert(sizeof(StatisticsBytes) == 4 * sizeof(uint32_t) + 6 * sizeof(double));

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

} // namespace

PixelStatistics statisticsOf(std::span<const gpu::PixelState> strands) {
    if (strands.size() == 1) return statisticsOf(strands.front());
    PixelStatistics all;
    for (uint32_t i = 0; i < strands.size(); ++i)
        all.mergeStrand(statisticsOf(strands[i]), i, uint32_t(strands.size()));
    return all;
}

size_t KeptPixels::bytesPerPixel() const {
    return as == As::States ? strands * sizeof(gpu::PixelState) : sizeof(StatisticsBytes);
}

bool KeptPixels::isWhole() const {
    return (as == As::Statistics || as == As::States) && strands > 0 &&
           bytes.size() % bytesPerPixel() == 0;
}

std::span<const gpu::PixelState> KeptPixels::states() const {
    if (as != As::States) throw std::invalid_argument("the saved film is not the kernel's");
    return {reinterpret_cast<const gpu::PixelState*>(bytes.data()),
            bytes.size() / sizeof(gpu::PixelState)};
}

PixelStatistics KeptPixels::statistics(size_t pixel) const {
    if (as == As::States)
        return stromboli::statisticsOf(states().subspan(pixel * strands, strands));
    StatisticsBytes kept;
    std::memcpy(&kept, bytes.data() + pixel * sizeof(kept), sizeof(kept));
    return {kept.count, kept.rejected, kept.firstRejected, kept.mean, kept.m2};
}

void KeptPixels::empty(size_t pixels) {
    bytes.assign(as == As::States ? pixels * bytesPerPixel() : 0, std::byte(0));
    while (as == As::Statistics && count() < pixels)
        append(PixelStatistics{});
}

KeptPixels KeptPixels::part(PixelRun run) const {
    const auto bytesOfRun =
        std::span(bytes).subspan(run.first * bytesPerPixel(), run.count * bytesPerPixel());
    return {as, strands, {bytesOfRun.begin(), bytesOfRun.end()}};
}

void KeptPixels::put(PixelRun run, const KeptPixels& pixels) {
    if (!sameKind(pixels) || pixels.count() != run.count ||
        uint64_t(run.first) + run.count > count())
        throw std::invalid_argument("the saved film is of another kind");
    std::ranges::copy(pixels.bytes, bytes.begin() + std::ptrdiff_t(run.first * bytesPerPixel()));
}

void KeptPixels::append(const PixelStatistics& p) {
    const StatisticsBytes row = {p.count, p.rejected, p.firstRejected, 0, p.mean, p.m2};
    const auto* const first = reinterpret_cast<const std::byte*>(&row);
    bytes.insert(bytes.end(), first, first + sizeof(row));
}

void KeptPixels::append(std::span<const gpu::PixelState> states) {
    const std::span<const std::byte> added = std::as_bytes(states);
    bytes.insert(bytes.end(), added.begin(), added.end());
}

} // namespace stromboli

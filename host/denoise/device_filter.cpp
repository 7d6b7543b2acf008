#include "host/denoise/device_filter.hpp"

#include "embedded/denoise_blend_storage.h"
#include "embedded/denoise_blend_texel.h"
#include "embedded/denoise_filter_storage.h"
#include "embedded/denoise_filter_texel.h"
#include "embedded/denoise_pilot_storage.h"
#include "embedded/denoise_pilot_texel.h"
#include "embedded/denoise_regress_storage.h"
#include "embedded/denoise_regress_texel.h"
#include "embedded/denoise_sum_rows_storage.h"
#include "embedded/denoise_sum_rows_texel.h"
#include "host/denoise/taps.hpp"

#include <algorithm>
#include <array>

namespace stromboli::denoise {
namespace {

using vulkan::Binding;
using vulkan::Buffer;
using vulkan::BufferUse;

/// A shader, and the buffers that it has.
struct PassPlan {
    std::span<const uint32_t> storage, texel;
    std::vector<uint32_t> bindings;
};

const std::array<PassPlan, 5>& passes() {
    static const std::array<PassPlan, 5> all = {{
        {denoise_pilot_storage,
         denoise_pilot_texel,
         {DENOISE_BINDING_PIXELS, DENOISE_BINDING_PILOTS}},
        {denoise_regress_storage,
         denoise_regress_texel,
         {DENOISE_BINDING_PIXELS, DENOISE_BINDING_PILOTS, DENOISE_BINDING_REGRESSIONS}},
        {denoise_filter_storage,
         denoise_filter_texel,
         {DENOISE_BINDING_TAPS, DENOISE_BINDING_PIXELS, DENOISE_BINDING_PILOTS,
          DENOISE_BINDING_REGRESSIONS, DENOISE_BINDING_CANDIDATES, DENOISE_BINDING_MOMENTS}},
        {denoise_sum_rows_storage,
         denoise_sum_rows_texel,
         {DENOISE_BINDING_MOMENTS, DENOISE_BINDING_SUMS}},
        {denoise_blend_storage,
         denoise_blend_texel,
         {DENOISE_BINDING_PIXELS, DENOISE_BINDING_CANDIDATES, DENOISE_BINDING_MOMENTS,
          DENOISE_BINDING_SUMS, DENOISE_BINDING_RESULTS}},
    }};
    return all;
}

/// Bytes of a pixel in each buffer but the taps.
constexpr std::array<uint64_t, DENOISE_BINDING_COUNT> kBytesPerPixel = {
    0,
    sizeof(gpu::DenoisePixel),
    sizeof(gpu::DenoisePilot),
    3 * sizeof(gpu::DenoiseCandidate),
    sizeof(gpu::DenoiseMoments),
    sizeof(gpu::DenoiseMoments),
    sizeof(gpu::DenoiseResult),
    sizeof(gpu::DenoiseCandidate)};
constexpr std::array<const char*, DENOISE_BINDING_COUNT> kNames = {
    "denoiser's taps",    "denoiser's pixels", "denoiser's pilots", "denoiser's candidates",
    "denoiser's moments", "denoiser's sums",   "denoised pixels",   "denoiser's regressions"};

/// The most that one of them takes.
constexpr uint64_t kLargest = *std::ranges::max_element(kBytesPerPixel);

/// A dispatch has so many where somebody may want it no longer: a tenth of a second on two cores.
constexpr uint32_t kRowsBetweenQuestions = 48;

/// As for the path kernel's (docs/theory/kernel.md, "Fetch").
bool prefersTexels(const vulkan::DeviceDescription& device, uint64_t pixels) {
    const std::vector<BufferUse> texels(passes()[1].bindings.size(), BufferUse::Texel);
    return device.isCpu() && vulkan::areBindable(device, texels) &&
           pixels * kLargest <= vulkan::bindingLimit(device, BufferUse::Texel).bytes;
}

} // namespace

/// What a strip needs.
struct DeviceFilter::Buffers {
    std::vector<Buffer> all;                 ///< by binding
    std::vector<vulkan::DescriptorSet> sets; ///< by pass
};

DeviceFilter::DeviceFilter(const vulkan::Device& device, const FilterTuning& tuning)
    : device_(device), tuning_(tuning),
      texelFetch_(
          tuning.texelFetch.value_or(prefersTexels(device.description(), tuning.pixelsAtOnce))),
      queue_(device), taps_(taps()) {
    const BufferUse use = texelFetch_ ? BufferUse::Texel : BufferUse::Storage;
    const uint64_t most = vulkan::bindingLimit(device.description(), use).bytes;
    tuning_.pixelsAtOnce = uint32_t(std::min<uint64_t>(tuning.pixelsAtOnce, most / kLargest));
    for (const PassPlan& pass : passes()) {
        std::vector<Binding> bindings;
        for (const uint32_t number : pass.bindings)
            bindings.push_back({number, use});
        pipelines_.emplace_back(device, texelFetch_ ? pass.texel : pass.storage, bindings,
                                std::span<const uint32_t>(),
                                uint32_t(sizeof(gpu::DenoiseDispatch)));
    }
}

std::vector<gpu::DenoiseResult> DeviceFilter::run(const Prepared& picture,
                                                  const std::function<bool()>& isUnwanted) {
    std::vector<gpu::DenoiseResult> results(picture.pixels.size());
    if (results.empty()) return results;
    // A strip and what its results depend on above and below; a row at least, whether it fits or
    // not: the buffer then says which limit is too low.
    const uint32_t rowsAtOnce = std::max(tuning_.pixelsAtOnce / picture.width, 2 * kHalo + 1);
    const uint32_t stripRows = std::min(rowsAtOnce - 2 * kHalo, picture.height);
    const uint64_t pixels =
        uint64_t(std::min(stripRows + 2 * kHalo, picture.height)) * picture.width;

    Buffers buffers;
    const BufferUse use = texelFetch_ ? BufferUse::Texel : BufferUse::Storage;
    for (uint32_t i = 0; i < DENOISE_BINDING_COUNT; ++i)
        buffers.all.emplace_back(device_, kNames[i],
                                 i == DENOISE_BINDING_TAPS ? taps_.size() * sizeof(gpu::DenoiseTap)
                                                           : pixels * kBytesPerPixel[i],
                                 use);
    buffers.all[DENOISE_BINDING_TAPS].upload(queue_, std::as_bytes(std::span(taps_)));
    for (size_t i = 0; i < pipelines_.size(); ++i) {
        std::vector<const Buffer*> bound;
        for (const uint32_t number : passes()[i].bindings)
            bound.push_back(&buffers.all[number]);
        buffers.sets.emplace_back(device_, pipelines_[i], bound);
    }
    for (uint32_t first = 0; first < picture.height; first += stripRows)
        if (!runStrip(picture, {first, std::min(first + stripRows, picture.height)}, buffers,
                      isUnwanted, results))
            return {};
    return results;
}

DeviceFilter::Rows DeviceFilter::around(Rows rows, uint32_t reach, uint32_t height) const {
    return {rows.first - std::min(rows.first, reach), std::min(rows.end + reach, height)};
}

/// Returns false if it was given up.
bool DeviceFilter::runStrip(const Prepared& picture, Rows rows, Buffers& buffers,
                            const std::function<bool()>& isUnwanted,
                            std::vector<gpu::DenoiseResult>& results) {
    const Rows all = around(rows, kHalo, picture.height);
    // What each pass makes, so that the next has all that it looks at.
    const uint32_t window = gpu::DENOISE_WINDOW_REACH;
    const std::array<Rows, 5> made = {
        around(rows, window + kReach, picture.height), around(rows, window, picture.height),
        around(rows, window, picture.height), around(rows, window, picture.height), rows};
    const size_t width = picture.width;
    buffers.all[DENOISE_BINDING_PIXELS].upload(
        queue_,
        std::as_bytes(std::span(picture.pixels).subspan(all.first * width, all.count() * width)));
    const auto record = [&](VkCommandBuffer commands, size_t pass, Rows part) {
        const gpu::DenoiseDispatch dispatch = {picture.width,
                                               picture.height,
                                               all.first,
                                               part.first,
                                               part.count(),
                                               uint32_t(taps_.size()),
                                               float(picture.floor * picture.floor)};
        const uint64_t pixels = uint64_t(part.count()) * width;
        vulkan::recordDispatch(device_, commands, pipelines_[pass], buffers.sets[pass],
                               std::as_bytes(std::span(&dispatch, 1)),
                               uint32_t((pixels + DENOISE_GROUP_SIZE - 1) / DENOISE_GROUP_SIZE));
    };
    if (isUnwanted) {
        for (size_t pass = 0; pass < pipelines_.size(); ++pass)
            for (Rows part = made[pass]; part.count() > 0; part.first += kRowsBetweenQuestions) {
                if (isUnwanted()) return false;
                const uint32_t end = std::min(part.first + kRowsBetweenQuestions, part.end);
                queue_.run("denoise rows", [&](VkCommandBuffer commands) {
                    record(commands, pass, {part.first, end});
                });
                if (end == part.end) break;
            }
    } else {
        queue_.run("denoise a picture", [&](VkCommandBuffer commands) {
            for (size_t pass = 0; pass < pipelines_.size(); ++pass)
                record(commands, pass, made[pass]);
        });
    }
    buffers.all[DENOISE_BINDING_RESULTS].download(
        queue_,
        std::as_writable_bytes(
            std::span(results).subspan(rows.first * width, rows.count() * width)),
        (rows.first - all.first) * width * sizeof(gpu::DenoiseResult));
    return true;
}

} // namespace stromboli::denoise

#include "host/engine/render_result.hpp"

#include "host/film/shown_film.hpp"
#include "host/render/sampling_plan.hpp"

#include <algorithm>
#include <functional>
#include <iterator>

namespace stromboli {

// --- Results -------------------------------------------------------------------------------------

void count(const Film& film, const RenderSettings& settings, RenderResult& r) {
    for (uint32_t i = 0; i < film.pixels.size(); ++i) {
        const PixelStatistics& p = film.pixels[i];
        r.samplesTaken += uint64_t(p.taken()) * settings.estimator.branches;
        r.samplesRejected += p.rejected;
        if (p.rejected == 0 || r.firstRejected) continue;
        const PixelPlace place = film.area.placeOf(i);
        r.firstRejected = SampleName{place.x, place.y, p.firstRejected};
    }
    r.pixelsUnreached += unreachedPixels(film);
}

// --- Channels of what is seen --------------------------------------------------------------------

namespace {

/// Calls `take` with the first pixel of each run and what is seen in it.
void lookAtAll(Viewer& viewer, const Film& film, Seeing what,
               const std::function<uint32_t(const PixelStatistics&)>& samplesOf,
               const std::function<void(size_t, std::span<const SeenPixel>)>& take,
               const std::function<bool()>& isUnwanted = {}) {
    constexpr size_t kBetweenQuestions = 1 << 15;
    const size_t all = film.pixels.size();
    const size_t most = isUnwanted ? kBetweenQuestions : Viewer::kMostSeenAtOnce;
    for (size_t first = 0; first < all; first += most) {
        if (isUnwanted && isUnwanted()) return;
        const size_t count = std::min<size_t>(most, all - first);
        std::vector<uint32_t> samples(count);
        for (size_t i = 0; i < count; ++i)
            samples[i] = samplesOf(film.pixels[first + i]);
        take(first, viewer.see(uint32_t(first), samples, what));
    }
}

/// Alpha is that of the very samples that the radiance is the mean of.
void addAlpha(FloatImage& image, Viewer& viewer, const Film& film) {
    std::vector<float>& alpha = image.channel(kAlphaChannel);
    lookAtAll(viewer, film, Seeing::Coverage, &PixelStatistics::taken,
              [&](size_t first, std::span<const SeenPixel> seen) {
                  for (size_t i = 0; i < seen.size(); ++i)
                      alpha[first + i] = float(seen[i].coverage());
              });
    for (uint32_t y = 0; y < film.height; ++y)
        for (uint32_t x = 0; x < film.width; ++x)
            alpha[size_t(y) * film.width + x] = alpha[shownPixel(film, x, y, NoisePlan::kCoarsest)];
}

/// Layers are those of the same camera rays, however far the render came.
void addLayerChannels(FloatImage& image, Viewer& viewer, const Film& film, const Scene& scene,
                      const Camera& camera, const RenderRequest& request,
                      const std::function<bool()>& isUnwanted = {}) {
    const uint32_t samples = std::min(kLayerSamples, request.budget.pathsPerPixel());
    lookAtAll(
        viewer, film, Seeing::Surfaces, [&](const PixelStatistics&) { return samples; },
        [&](size_t first, std::span<const SeenPixel> seen) {
            addLayers(image, request.layers, first, seen, scene, camera);
        },
        isUnwanted);
}

} // namespace

FloatImage seenChannels(Viewer* viewer, const Film& film, const Scene& scene, const Camera& camera,
                        const RenderRequest& request, const std::function<bool()>& isUnwanted) {
    FloatImage image(film.area);
    for (const std::string& name : request.channels())
        image.channel(name);
    if (!viewer) {
        if (request.transparent) std::ranges::fill(image.channel(kAlphaChannel), 1.0f);
        return image;
    }
    if (request.transparent) addAlpha(image, *viewer, film);
    if (request.layers.empty()) return image;
    addLayerChannels(image, *viewer, film, scene, camera, request, isUnwanted);
    return image;
}

std::vector<float> layersByPixel(Viewer& viewer, const Film& film, const Scene& scene,
                                 const Camera& camera, const RenderRequest& request) {
    FloatImage image(film.area);
    addLayerChannels(image, viewer, film, scene, camera, request);
    std::vector<std::string> names;
    for (const Layer layer : request.layers)
        std::ranges::copy(channelsOf(layer), std::back_inserter(names));
    std::vector<float> values(film.pixels.size() * names.size());
    for (size_t c = 0; c < names.size(); ++c) {
        const std::vector<float>& channel = image.channel(names[c]);
        for (size_t i = 0; i < channel.size(); ++i)
            values[i * names.size() + c] = channel[i];
    }
    return values;
}

} // namespace stromboli

#include "host/render/kept_film.hpp"

#include <stdexcept>

namespace stromboli {

PixelStatistics statisticsOf(const PixelSums& s, KeptSums kind) {
    PixelStatistics p;
    p.count = s.count;
    p.rejected = s.rejected;
    if (s.rejected > 0) p.firstRejected = s.firstRejected;
    if (s.count == 0) return p;
    const bool isSum = kind == KeptSums::Sums;
    p.mean = isSum ? (s.first + s.firstError) / double(s.count) : s.first;
    p.m2 = isSum ? s.second + s.secondError : s.second;
    return p;
}

Film filmOf(const SessionState& state, KeptSums kind) {
    Film film(state.settings.area);
    film.branches = state.settings.estimator.branches;
    const bool isInBlocks = !state.blocks.empty();
    if (state.sums.size() != film.pixels.size() ||
        (isInBlocks && state.blocks.size() != film.pixels.size()))
        throw std::invalid_argument("the saved film is not of this picture");
    // The block under way is added to those that are done.
    const bool maybeInBlocks = state.settings.budget.samplesPerBlock > 0;
    const uint32_t firstSample = isInBlocks ? state.blocks.front().taken() : 0;
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        film.pixels[i] = statisticsOf(state.sums[i], kind);
        if (!maybeInBlocks) continue;
        ExactStatistics exact = isInBlocks ? state.blocks[i] : ExactStatistics{};
        exact.add(film.pixels[i], firstSample);
        film.pixels[i] = exact.statistics();
    }
    return film;
}

PictureNoise noiseOf(const SessionState& state, const Film& film) {
    NoiseEstimate estimate;
    estimate.remember(state.estimate);
    if (!state.pending.empty()) estimate.update(film); // as SamplingSession does
    return estimate.picture(film);
}

} // namespace stromboli

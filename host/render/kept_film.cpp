#include "host/render/kept_film.hpp"

#include <stdexcept>

namespace stromboli {

Film filmOf(const SessionState& state) {
    Film film(state.settings.area);
    film.branches = state.settings.estimator.branches;
    const bool isInBlocks = !state.blocks.empty();
    if (state.pixels.count() != film.pixels.size() ||
        (isInBlocks && state.blocks.size() != film.pixels.size()))
        throw std::invalid_argument("the saved film is not of this picture");
    // The block under way is added to those that are done.
    const bool maybeInBlocks = state.settings.budget.samplesPerBlock > 0;
    const uint32_t firstSample = isInBlocks ? state.blocks.front().taken() : 0;
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        film.pixels[i] = state.pixels.statistics(i);
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

#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/picture_noise.hpp"
#include "host/render/sampling_session.hpp"

namespace stromboli {

/// How a kind of backend keeps a pixel (PixelSums).
enum class KeptSums {
    Sums, ///< the kernel
    Means ///< backends that keep nothing beside the film
};

PixelStatistics statisticsOf(const PixelSums& sums, KeptSums kind);

/// The film of a render that was saved, and what was known of its noise: what a session that goes
/// on has before its first sample.
Film filmOf(const SessionState& state, KeptSums kind);
PictureNoise noiseOf(const SessionState& state, const Film& film);

} // namespace stromboli

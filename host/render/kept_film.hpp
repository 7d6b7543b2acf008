#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/picture_noise.hpp"
#include "host/render/sampling_session.hpp"

namespace stromboli {

/// The film of a render that was saved, and what was known of its noise: what a session that goes
/// on has before its first sample.
Film filmOf(const SessionState& state);
PictureNoise noiseOf(const SessionState& state, const Film& film);

} // namespace stromboli

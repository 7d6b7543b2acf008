#pragma once

#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// It is light from all around: constant, envmap, sky, sun or sunsky.
bool isEnvironment(const Plugin& emitter);

/// What turns the file's world so that the environment map, which `emitter` is, stands upright.
/// Throws SceneError if its to_world does more than turn, mirror and scale alike.
glm::dmat4 worldFromFileOf(const Plugin& emitter);

/// The picture around the scene.
void setEnvironmentMap(Context& context, const Plugin& emitter);

} // namespace stromboli::mitsuba

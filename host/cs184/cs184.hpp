#pragma once

#include "host/render/estimator.hpp"
#include "scene/build/conventions.hpp"
#include "scene/camera/camera.hpp"

namespace stromboli {

// What the CS184 renderer (docs/guide/cs184.md) does in its own way, as values of conventions that
// the rest of the program asks for by their names. Nothing but the option --cs184
// (host/cli/cs184_options.hpp) and tests take them up.

/// How it reads files.
SceneConventions cs184Conventions();

/// Where it puts the camera.
FramingConventions cs184Framing();

/// How its surfaces and lights shine.
ShadingConventions cs184Shading();

} // namespace stromboli

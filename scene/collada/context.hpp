#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/collada/document.hpp"

namespace stromboli::collada {

/// What every part of the loader reads from and writes to.
struct Context {
    const Document& document;
    build::SceneBuilder& builder;
    build::Report& report = builder.report();
    const SceneConventions& conventions = builder.conventions();
};

} // namespace stromboli::collada

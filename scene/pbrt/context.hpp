#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/build/tubes.hpp"
#include "scene/pbrt/files.hpp"
#include "scene/pbrt/version.hpp"

namespace stromboli::pbrt {

/// What is passed to whatever reads a part of the scene.
struct Context {
    build::SceneBuilder& builder;
    const Files& files;
    Version version = Version::V4;
    /// What the film makes of light; all light of the scene is multiplied by it.
    double imagingRatio = 1;
    build::TubeDetail tubes; ///< of curves

    build::Report& report() const { return builder.report(); }
    bool isV3() const { return version == Version::V3; }
};

} // namespace stromboli::pbrt

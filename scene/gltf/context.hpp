#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/gltf/document.hpp"

#include <optional>

namespace stromboli::gltf {

/// What is passed to whatever reads a part of the file.
struct Context {
    const Document& document;
    build::SceneBuilder& builder;
    /// The variant of KHR_materials_variants that is shown.
    std::optional<size_t> variant;

    build::Report& report() const { return builder.report(); }
    const FileSelection& selection() const { return builder.conventions().selection; }
};

} // namespace stromboli::gltf

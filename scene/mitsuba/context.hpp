#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/mitsuba/document.hpp"

namespace stromboli::mitsuba {

/// What is passed to whatever reads a part of the scene.
struct Context {
    const Document& document;
    build::SceneBuilder& builder;
    /// The file's world is turned so that its environment map stands upright, y up.
    glm::dmat4 worldFromFile{1.0};
    /// The emitter that is all around; null: there is none.
    const Plugin* environment = nullptr;
    size_t bsdfsRead = 0; ///< each as often as it is inside of others

    build::Report& report() const { return builder.report(); }
};

/// Parameters that nothing read, of an object that has little to do with the picture, become a line
/// of the report.
void ignoreUnread(const Context& context, const Plugin& plugin);

} // namespace stromboli::mitsuba

#pragma once

#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <string>

namespace stromboli::test {

/// A scene of scene/library and a small picture of it.
struct LibraryPicture {
    Scene scene;
    RenderSettings settings;
    Camera camera;
};

LibraryPicture libraryPicture(const std::string& name, uint32_t width = 48, uint32_t height = 36,
                              uint32_t samples = 1);

} // namespace stromboli::test

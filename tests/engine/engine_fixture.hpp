#pragma once

#include "host/engine/load_scene.hpp"
#include "host/engine/render_session.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stromboli::test {

/// A bundled scene.
std::shared_ptr<Scene> bundled(const std::string& name);

/// A small picture of so many samples a pixel, the same number for all.
RenderRequest smallPicture(uint32_t samples, PictureSize size = {24, 18});

/// A view of the Cornell box from another place than its file's camera.
CameraRequest fromTheSide();

/// The film of a picture in a session of its own.
Film alone(const DeviceRequest& device, std::shared_ptr<const Scene> scene,
           const RenderRequest& request);

/// Whether all pixels have the same numbers of samples, means and squared deviations, to the bit.
bool sameBytes(const Film& a, const Film& b);

/// What the floor of boardOverFloor() reflects.
inline constexpr float kFloorAlbedo = 0.5F;
/// A grey floor over all the picture, "floor" of the material "grey", and a board above it.
Scene boardOverFloor(const glm::vec3& boardAlbedo);
/// White from all around.
void addSky(Scene& scene);
/// Straight from above.
void addSun(Scene& scene);
/// Seen slantwise from above, so that the board covers a part of the picture and not all of its
/// shadow.
RenderRequest fromAbove(uint32_t samples);

/// Keeps what an engine says.
struct Told {
    std::vector<std::string> messages;
    std::vector<Stage> stages;

    Listener listener();
    size_t count(Stage stage) const;
};

/// After this many reports of progress the picture is to be cancelled, or paused.
SessionEvents after(int reports, Next what);

} // namespace stromboli::test

#pragma once

#include "host/api/named_values.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/image.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace stromboli::api {

/// A line that the engine has to say.
struct Message {
    Severity severity = Severity::Information;
    std::string text;
};

/// Keeps what the engine says, on whichever thread it says it, until the program asks for it.
class MessageQueue {
  public:
    /// For engines that end before the queue does.
    Listener listener();
    /// What has been said since the last call.
    std::vector<Message> take();

  private:
    std::mutex mutex_;
    std::vector<Message> messages_;
};

/// Parameters of one material or light: names and values of setMaterial() or setLight().
using NamedChange = std::vector<std::pair<std::string, Value>>;

/// A RenderSession whose pictures are channels of floats: R, G, B (linear radiance), samples,
/// variance.R, .G, .B (of the mean), and the layers that the request asks for, by the names that
/// they have in EXR files (docs/guide/layers.md). They are the numbers that `stromboli render --aov
/// -o NAME.exr` writes.
class PictureSession {
  public:
    explicit PictureSession(const DeviceRequest& device);

    void begin(std::shared_ptr<const Scene> scene, const RenderRequest& request);
    /// Both throw UsageError if no picture has been begun.
    void moveCamera(const CameraRequest& camera);
    /// By the number of the material in the scene. Throws UsageError for a material that is not
    /// there, and where it would differ in more than numbers.
    void changeMaterials(const std::map<uint32_t, NamedChange>& changes);
    /// By the number of the light in the scene. Throws UsageError for one that is not there.
    void changeLights(const std::map<uint32_t, NamedChange>& changes);
    /// By the number of the object (Scene::instances): the motion from where the scene as it was
    /// read has it, in the file's coordinates. Throws UsageError (ChangingScene::apply()).
    void moveObjects(const std::map<uint32_t, glm::dmat4>& motions);

    /// As RenderSession::pass().
    bool pass(const std::function<Next(const RenderProgress&)>& progress);
    /// From any thread.
    void cancel() { session_.cancel(); }

    bool isBegun() const { return scene_ != nullptr; }
    bool isOver() const { return session_.isOver(); }
    RenderResult result() const { return session_.result(); }
    /// Throw UsageError if no picture has been begun.
    const RenderRequest& request() const;
    const RenderSettings& settings() const;
    /// The materials of the picture, with what has been changed.
    const std::vector<Material>& materials() const {
        require();
        return session_.scene().materials;
    }
    /// The picture so far; not during pass(). Throws UsageError if no sample has been taken.
    const FloatImage& image();

    std::vector<Message> takeMessages() { return messages_.take(); }

  private:
    void require() const;
    void hasBegun();
    void change(const SceneChange& change);
    void place(FloatImage part);

    MessageQueue messages_; // outlives the session
    RenderSession session_;
    std::shared_ptr<const Scene> scene_;
    FloatImage image_;
    bool isPlaced_ = false; ///< the last pass's samples are in `image_`
    bool isTaken_ = false;  ///< there are samples
};

} // namespace stromboli::api

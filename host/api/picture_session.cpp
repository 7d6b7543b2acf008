#include "host/api/picture_session.hpp"

#include "host/api/named_lights.hpp"
#include "host/api/named_materials.hpp"
#include "host/core/error.hpp"
#include "host/film/image_file.hpp"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace stromboli::api {

// --- Messages ------------------------------------------------------------------------------------

Listener MessageQueue::listener() {
    Listener listener;
    listener.message = [this](Severity severity, const std::string& text) {
        const std::lock_guard lock(mutex_);
        messages_.push_back({severity, text});
    };
    return listener;
}

std::vector<Message> MessageQueue::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

// --- Sessions ------------------------------------------------------------------------------------

PictureSession::PictureSession(const DeviceRequest& device)
    : session_(device, messages_.listener()) {}

void PictureSession::require() const {
    if (!scene_) throw UsageError("no picture has been begun in this session");
}

const RenderRequest& PictureSession::request() const {
    require();
    return session_.request();
}

const RenderSettings& PictureSession::settings() const {
    require();
    return session_.picture().settings;
}

void PictureSession::hasBegun() {
    image_ = FloatImage(session_.picture().settings.area);
    isPlaced_ = isTaken_ = false;
}

void PictureSession::begin(std::shared_ptr<const Scene> scene, const RenderRequest& request) {
    session_.begin(scene, request);
    scene_ = std::move(scene);
    hasBegun();
}

void PictureSession::moveCamera(const CameraRequest& camera) {
    require();
    session_.moveCamera(camera);
    hasBegun();
}

void PictureSession::change(const SceneChange& change) {
    try {
        session_.change(change);
    } catch (const std::invalid_argument& error) {
        throw UsageError(error.what());
    }
    hasBegun();
}

void PictureSession::changeMaterials(const std::map<uint32_t, NamedChange>& changes) {
    require();
    SceneChange all;
    for (const auto& [number, change] : changes) {
        if (number >= materials().size())
            throw UsageError(
                fmt::format("there is no material {}: there are {}", number, materials().size()));
        Material material = materials()[number];
        for (const auto& [parameter, value] : change)
            setMaterial(material, parameter, value);
        all.materials.emplace(number, std::move(material));
    }
    change(all);
}

void PictureSession::changeLights(const std::map<uint32_t, NamedChange>& changes) {
    require();
    SceneChange all;
    for (const auto& [number, change] : changes) {
        const std::vector<Light>& lights = session_.scene().lights;
        if (number >= lights.size())
            throw UsageError(
                fmt::format("there is no light {}: there are {}", number, lights.size()));
        Light light = lights[number];
        for (const auto& [parameter, value] : change)
            setLight(light, scene_->origin, parameter, value);
        requireLight(light);
        all.lights.emplace(number, std::move(light));
    }
    change(all);
}

void PictureSession::moveObjects(const std::map<uint32_t, glm::dmat4>& motions) {
    require();
    SceneChange all;
    const glm::dmat4 toFile = glm::translate(glm::dmat4(1), scene_->origin),
                     toWorld = glm::translate(glm::dmat4(1), -scene_->origin);
    for (const auto& [number, motion] : motions)
        all.motions.emplace(number,
                            scene_->origin == glm::dvec3(0) ? motion : toWorld * motion * toFile);
    change(all);
}

bool PictureSession::pass(const std::function<Next(const RenderProgress&)>& progress) {
    require();
    isPlaced_ = false;
    SessionEvents events;
    events.progress = progress;
    events.bandDone = [this](const FinishedBand& band) {
        FloatImage part = linearPicture(band.film, true);
        part.channels.insert(band.beside.channels.begin(), band.beside.channels.end());
        place(std::move(part));
    };
    const bool hasMore = session_.pass(events);
    isTaken_ = true;
    isPlaced_ = session_.isOver();
    return hasMore;
}

/// Bands are whole rows of the picture.
void PictureSession::place(FloatImage part) {
    image_.branches = part.branches;
    if (part.width == image_.width && part.height == image_.height) {
        image_.channels = std::move(part.channels);
        return;
    }
    const size_t first =
        size_t(part.area.rendered().y - image_.area.rendered().y) * size_t(part.width);
    for (const auto& [name, values] : part.channels)
        std::ranges::copy(values, image_.channel(name).begin() + std::ptrdiff_t(first));
}

const FloatImage& PictureSession::image() {
    require();
    if (!isTaken_) throw UsageError("no sample of the picture has been taken");
    if (!isPlaced_) place(session_.pixels(true));
    isPlaced_ = true;
    return image_;
}

} // namespace stromboli::api

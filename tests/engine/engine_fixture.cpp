#include "tests/engine/engine_fixture.hpp"

#include <algorithm>
#include <cstring>

namespace stromboli::test {

std::shared_ptr<Scene> bundled(const std::string& name) {
    return loadScene({name, {}, {}}).scene;
}

RenderRequest smallPicture(uint32_t samples, PictureSize size) {
    RenderRequest request;
    request.size = size;
    request.branches = 1;
    request.budget.mostPathsPerPixel = samples;
    request.estimator.maxBounces = 3;
    return request;
}

CameraRequest fromTheSide() {
    CameraRequest camera;
    camera.from = glm::dvec3(0.4, 0.6, 1.1);
    camera.at = glm::dvec3(0, 0.5, 0);
    return camera;
}

Film alone(const DeviceRequest& device, std::shared_ptr<const Scene> scene,
           const RenderRequest& request) {
    RenderSession session(device);
    session.begin(std::move(scene), request);
    session.run();
    return session.film();
}

bool sameBytes(const Film& a, const Film& b) {
    return std::ranges::equal(
        a.pixels, b.pixels, [](const PixelStatistics& p, const PixelStatistics& q) {
            return p.count == q.count && std::memcmp(&p.mean, &q.mean, sizeof p.mean) == 0 &&
                   std::memcmp(&p.m2, &q.m2, sizeof p.m2) == 0;
        });
}

Listener Told::listener() {
    return {[this](Severity, const std::string& text) { messages.push_back(text); },
            [this](Stage stage, const std::string&) { stages.push_back(stage); }};
}

size_t Told::count(Stage stage) const {
    return size_t(std::ranges::count(stages, stage));
}

SessionEvents after(int reports, Next what) {
    SessionEvents events;
    events.progress = [reports, what](const RenderProgress&) mutable {
        return reports-- > 0 ? Next::GoOn : what;
    };
    return events;
}

} // namespace stromboli::test

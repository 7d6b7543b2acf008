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

namespace {

void addSquare(Scene& scene, float height, float reach, uint32_t material) {
    const auto first = uint32_t(scene.positions.size());
    for (const glm::vec2& p : {glm::vec2(-1, 1), {1, 1}, {1, -1}, {-1, -1}})
        scene.positions.emplace_back(reach * p.x, height, reach * p.y);
    const auto instance = uint32_t(scene.instances.size() - 1);
    for (const uint32_t last : {2u, 3u}) {
        Triangle t;
        t.corner[0] = first, t.corner[1] = first + last - 1, t.corner[2] = first + last;
        t.material = material, t.instance = instance;
        scene.triangles.push_back(t);
    }
}

} // namespace

Scene boardOverFloor(const glm::vec3& boardAlbedo) {
    Scene scene;
    scene.file = "board";
    scene.materials.resize(2);
    scene.materials[0].name = "grey";
    scene.materials[0].albedo = glm::vec3(kFloorAlbedo);
    scene.materials[1].name = "board";
    scene.materials[1].albedo = boardAlbedo;
    scene.instances = {"floor"};
    addSquare(scene, 0, 100, 0);
    scene.instances.emplace_back("a board");
    addSquare(scene, 0.5F, 0.5F, 1);
    return scene;
}

void addSky(Scene& scene) {
    scene.environment.emplace();
    scene.environment->radiance = {glm::vec3(1)};
}

void addSun(Scene& scene) {
    Light sun;
    sun.kind = LightKind::Directional;
    sun.direction = {0, -1, 0};

    scene.lights.push_back(sun);
}

RenderRequest fromAbove(uint32_t samples) {
    RenderRequest request = smallPicture(samples, {16, 12});
    request.camera.from = glm::dvec3(0, 3, 2);
    request.camera.at = glm::dvec3(0, 0, 0);
    return request;
}

} // namespace stromboli::test

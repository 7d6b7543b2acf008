// Sessions on a device: what is kept from picture to picture, and what a process does not notice.
#include "tests/engine/engine_fixture.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <future>
#include <set>
#include <unistd.h>

namespace stromboli {
namespace {

using namespace test;

/// What belongs to the process and not to a session.
struct ProcessState {
    std::set<std::string> environment;
    std::array<void (*)(int), 4> handlers{};
    std::array<bool, 4> blocked{};

    static ProcessState now() {
        ProcessState state;
        for (char** variable = environ; *variable; ++variable)
            state.environment.insert(*variable);
        sigset_t mask;
        pthread_sigmask(SIG_SETMASK, nullptr, &mask);
        constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
        for (size_t i = 0; i < kSignals.size(); ++i) {
            struct sigaction action = {};
            sigaction(kSignals[i], nullptr, &action);
            state.handlers[i] = action.sa_handler;
            state.blocked[i] = sigismember(&mask, kSignals[i]) == 1;
        }
        return state;
    }
    bool operator==(const ProcessState&) const = default;
};

TEST(DeviceSession, LeavesTheProcessAsItIs) {
    const ProcessState before = ProcessState::now();
    const Film film = alone({}, bundled("cornell_spheres"), smallPicture(4));
    EXPECT_GT(film.at(12, 9).mean.g, 0);
    EXPECT_TRUE(ProcessState::now() == before);
}

TEST(DeviceSession, AMovedCameraBuildsNothingAndHasTheBytesOfASessionOfItsOwn) {
    const auto scene = bundled("cornell_spheres");
    RenderRequest request = smallPicture(16);
    Told told;
    RenderSession session({}, told.listener());
    session.begin(scene, request);
    session.pass(after(1, Next::Pause)); // the camera moves in the midst of a pass
    session.moveCamera(fromTheSide());
    const RenderResult result = session.run();
    EXPECT_EQ(result.buildSeconds, 0);
    EXPECT_EQ(told.count(Stage::Building), 1u);
    EXPECT_FALSE(sameBytes(session.film(), alone({}, scene, request)));
    request.camera = fromTheSide();
    EXPECT_TRUE(sameBytes(session.film(), alone({}, scene, request)));
}

/// Another way to find lights needs other tables.
TEST(DeviceSession, AnotherEstimatorHasTheBytesOfASessionOfItsOwn) {
    const auto scene = bundled("cornell_spheres");
    RenderRequest request = smallPicture(8);
    RenderSession session;
    session.begin(scene, request);
    session.run();
    request.estimator.directLight = DirectLight::Bsdf;
    session.begin(scene, request);
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), alone({}, scene, request)));
}

/// Colours, roughness and emission, whose lights are other ones then; glass that becomes rough has
/// another kernel.
TEST(DeviceSession, ChangedNumbersOfMaterialsBuildNothingAndHaveTheBytesOfASessionOfItsOwn) {
    for (const char* name : {"cornell_spheres", "still_life"}) {
        const auto scene = bundled(name);
        const RenderRequest request = smallPicture(8);
        Told told;
        RenderSession session({}, told.listener());
        session.begin(scene, request);
        session.run();
        const Film before = session.film();
        const auto edited = std::make_shared<Scene>(*scene);
        std::map<uint32_t, Material> numbers;
        for (uint32_t i = 0; i < scene->materials.size(); ++i) {
            Material& m = edited->materials[i];
            m.albedo *= glm::vec3(0.5f, 1, 0.25f);
            m.principled.roughness = 0.5f * (m.principled.roughness + 1);
            m.principled.baseColor *= glm::vec3(1, 0.5f, 1);
            m.facets.alpha = glm::vec2(0.2f);
            if (i % 2 == 0 && m.emits()) m.emission *= 3.0f;
            numbers[i] = m;
        }
        session.change({.materials = numbers, .lights = {}, .motions = {}});
        session.run();
        EXPECT_FALSE(sameBytes(session.film(), before)) << name;
        EXPECT_TRUE(sameBytes(session.film(), alone({}, edited, request))) << name;
        // Lights that go out, and all as it was.
        for (auto& [number, material] : numbers)
            material.emission = glm::vec3(0);
        session.change({.materials = numbers, .lights = {}, .motions = {}});
        session.run();
        for (auto& [number, material] : numbers)
            material = scene->materials[number];
        session.change({.materials = numbers, .lights = {}, .motions = {}});
        session.run();
        EXPECT_TRUE(sameBytes(session.film(), before)) << name;
        EXPECT_EQ(told.count(Stage::Building), 1u);
    }
}

TEST(DeviceSession, AnEditedMaterialHasTheBytesOfASessionOfItsOwn) {
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(8);
    RenderSession session;
    session.begin(scene, request);
    session.run();
    const Film before = session.film();
    const auto edited = std::make_shared<Scene>(*scene);
    for (Triangle& triangle : edited->triangles)
        triangle.material = 0;
    session.begin(edited, request);
    session.run();
    EXPECT_FALSE(sameBytes(session.film(), before));
    EXPECT_TRUE(sameBytes(session.film(), alone({}, edited, request)));
    session.begin(scene, request); // and back
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), before));
}

/// A mesh with textures, and one that is an instance of many: what moves is built, the rest is not.
TEST(DeviceSession, MovedObjectsHaveTheBytesOfASessionOfTheirOwn) {
    for (const char* name : {"still_life", "generate:forest:3"}) {
        const std::shared_ptr<const Scene> scene = bundled(name);
        const RenderRequest request = smallPicture(8);
        const uint32_t object = scene->placements.empty() ? scene->triangles.back().instance
                                                          : scene->placements[1].instance;
        const auto motion = [&](double x, double y) {
            SceneChange change;
            change.motions[object] = glm::translate(glm::dmat4(1), {x, y, 0});
            return change;
        };
        Told told;
        RenderSession session({}, told.listener());
        session.begin(scene, request);
        session.run();
        const Film before = session.film();
        session.change(motion(0.5, 0.25));
        session.change(motion(0.25, 0)); // before a sample was taken
        session.run();
        session.change(motion(-0.25, 0.125));
        session.run();
        ChangingScene changing(scene);
        changing.apply(motion(-0.25, 0.125));
        EXPECT_FALSE(sameBytes(session.film(), before)) << name;
        EXPECT_TRUE(sameBytes(session.film(), alone({}, changing.scene(), request))) << name;
        EXPECT_EQ(told.count(Stage::Building), 3u);
        session.change(motion(0, 0)); // back, and another scene in its place
        session.run();
        EXPECT_TRUE(sameBytes(session.film(), before)) << name;
        session.change(motion(0.25, 0));
        session.begin(bundled("cornell_boxes"), request);
        session.run();
        EXPECT_TRUE(sameBytes(session.film(), alone({}, bundled("cornell_boxes"), request)));
    }
}

/// Layers and denoiser are given up where they are not wanted, and can be asked for again.
TEST(DeviceSession, ADenoisedPictureMayBeGivenUp) {
    const auto scene = bundled("cornell_spheres");
    RenderSession session, other;
    for (RenderSession* s : {&session, &other}) {
        s->begin(scene, smallPicture(8));
        s->run();
    }
    for (const int last : {1, 2, 4}) { // while layers are traced, and while the filter is at work
        int asked = 0;
        EXPECT_EQ(session.denoisedUnless([&] { return ++asked >= last; }), nullptr) << last;
        EXPECT_GE(asked, last);
    }
    const denoise::DenoisedPicture* const wanted = session.denoisedUnless([] { return false; });
    ASSERT_NE(wanted, nullptr);
    EXPECT_EQ(wanted->mean, other.denoised().mean);
}

/// An environment that turns, with its tables, and one in its place: of a sun that has sunk.
TEST(DeviceSession, ATurnedOrOtherEnvironmentBuildsNothingAndHasTheBytesOfASessionOfItsOwn) {
    SceneRequest source{"still_life", {}, {}};
    source.environment.sun = SunRequest{135, 40};
    const std::shared_ptr<const Scene> scene = loadScene(source).scene;
    const RenderRequest request = smallPicture(8);
    Told told;
    RenderSession session({}, told.listener());
    session.begin(scene, request);
    session.run();
    const Film before = session.film();
    source.environment.sun = SunRequest{20, 40};
    SceneChange turn;
    turn.rotation = rotationOf(source.environment);
    session.change(turn);
    session.run();
    EXPECT_FALSE(sameBytes(session.film(), before));
    EXPECT_TRUE(sameBytes(session.film(), alone({}, loadScene(source).scene, request)));
    // Together with a material, and that back together with another sky.
    source.environment.sun = SunRequest{250, 40};
    const auto edited = std::make_shared<Scene>(*loadScene(source).scene);
    edited->materials[0].albedo *= 0.5f;
    edited->materials[0].principled.baseColor *= 0.5f;
    SceneChange both;
    both.rotation = rotationOf(source.environment);
    both.materials[0] = edited->materials[0];
    session.change(both);
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), alone({}, edited, request)));
    source.environment.sun = SunRequest{20, 15};
    turn.materials[0] = scene->materials[0];
    turn.environment = std::make_shared<Environment>(environmentOf(*source.environment.sun));
    session.change(turn);
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), alone({}, loadScene(source).scene, request)));
    EXPECT_EQ(told.count(Stage::Building), 1u);
    SceneChange back;
    back.environment = std::make_shared<Environment>(*scene->environment);
    session.change(back);
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), before));
}

TEST(DeviceSession, ChangedLightsBuildNothingAndHaveTheBytesOfASessionOfItsOwn) {
    const std::shared_ptr<const Scene> scene = bundled("light_spot");
    const RenderRequest request = smallPicture(8);
    ASSERT_FALSE(scene->lights.empty());
    SceneChange change;
    Light& light = change.lights[0] = scene->lights[0];
    light.position += glm::vec3(0.1f, -0.2f, 0.1f);
    light.color *= 2.0f;
    Told told;
    RenderSession session({}, told.listener());
    session.begin(scene, request);
    session.run();
    const Film before = session.film();
    session.change(change);
    session.run();
    ChangingScene changing(scene);
    changing.apply(change);
    EXPECT_FALSE(sameBytes(session.film(), before));
    EXPECT_TRUE(sameBytes(session.film(), alone({}, changing.scene(), request)));
    light = scene->lights[0];
    session.change(change);
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), before));
    EXPECT_EQ(told.count(Stage::Building), 1u);
}

/// A texture that multiplies 0 is left out of the scene on the device.
TEST(DeviceSession, ATextureThatBeginsToCountIsThere) {
    const std::shared_ptr<Scene> scene = bundled("still_life");
    std::map<uint32_t, Material> numbers;
    for (uint32_t i = 0; i < scene->materials.size(); ++i) {
        numbers[i] = scene->materials[i];
        scene->materials[i].principled.baseColor = glm::vec3(0);
    }
    const RenderRequest request = smallPicture(4);
    RenderSession session;
    session.begin(scene, request);
    session.run();
    session.change({.materials = numbers, .lights = {}, .motions = {}});
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), alone({}, bundled("still_life"), request)));
}

TEST(DeviceSession, SeveralAtTheSameTimeDoNotDisturbEachOther) {
    const auto scene = bundled("cornell_spheres");
    const RenderRequest front = smallPicture(16);
    RenderRequest side = front;
    side.camera = fromTheSide();
    const auto render = [&](const RenderRequest& request) {
        return std::async(std::launch::async, [&] { return alone({}, scene, request); });
    };
    auto one = render(front), two = render(side);
    const Film first = one.get(), second = two.get();
    EXPECT_FALSE(sameBytes(first, second));
    EXPECT_TRUE(sameBytes(first, alone({}, scene, front)));
    EXPECT_TRUE(sameBytes(second, alone({}, scene, side)));
    // Interleaved on one thread.
    RenderSession a, b;
    a.begin(scene, front);
    b.begin(scene, side);
    for (bool goesOn = true; goesOn;) {
        goesOn = a.pass(after(0, Next::Pause));
        goesOn = b.pass(after(0, Next::Pause)) || goesOn;
    }
    EXPECT_TRUE(sameBytes(a.film(), first));
    EXPECT_TRUE(sameBytes(b.film(), second));
}

TEST(DeviceSession, SavedItGoesOnInAnotherToTheSameBytes) {
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(40);
    RenderSession first;
    first.begin(scene, request);
    ASSERT_TRUE(first.pass(after(2, Next::Pause)));
    Keeping keeping;
    keeping.begun = first.save();
    RenderSession second;
    second.begin(scene, request, keeping);
    const RenderResult rest = second.run();
    EXPECT_LT(rest.counters.paths, rest.samplesTaken); // some were there
    first.run();
    EXPECT_TRUE(sameBytes(second.film(), first.film()));
    EXPECT_TRUE(sameBytes(first.film(), alone({}, scene, request)));
}

// --- Shadow catchers -----------------------------------------------------------------------------

FloatImage pictureOf(const Scene& scene, const RenderRequest& request) {
    RenderSession session;
    session.begin(std::make_shared<const Scene>(scene), request);
    session.run();
    return session.pixels();
}

TEST(DeviceSession, AShadowCatcherOfItsOwnColourIsThePictureWithTheFloor) {
    Scene scene = boardOverFloor({0.9F, 0.2F, 0.1F});
    addSky(scene);
    RenderRequest request = fromAbove(256);
    request.background = Background{1, 1, {glm::vec3(kFloorAlbedo)}};
    const std::vector<float> whole = pictureOf(scene, request).channels.at("R");
    request.shadowCatcher = "floor";
    const std::vector<float> caught = pictureOf(scene, request).channels.at("R");
    double sum = 0, difference = 0;
    for (size_t i = 0; i < whole.size(); ++i) {
        EXPECT_NEAR(whole[i], caught[i], 0.07) << i; // four standard errors of some 3 % noise
        sum += double(whole[i]), difference += double(caught[i] - whole[i]);
    }
    EXPECT_NEAR(difference / sum, 0, 0.01);
}

/// The catcher alone chooses among lights near and far as it does among the objects.
TEST(DeviceSession, AShadowCatcherCatchesNothingWhereObjectsChangeNothing) {
    Scene scene = boardOverFloor(glm::vec3(0));
    addSun(scene);
    for (int i = 0; i < 4; ++i) {
        Light lamp;
        lamp.position = {i - 2, 1, 3};
        lamp.constantAttenuation = 0, lamp.quadraticAttenuation = 1;
        scene.lights.push_back(lamp);
    }
    const auto first = uint32_t(scene.positions.size()); // out of sight, and it widens the scene
    for (const float x : {900.0F, 901.0F, 902.0F})
        scene.positions.emplace_back(x, 0, x - 900);
    Triangle far = scene.triangles.back();
    far.corner[0] = first, far.corner[1] = first + 1, far.corner[2] = first + 2;
    scene.triangles.push_back(far);
    scene.positions.back().y = 1;
    RenderRequest request = fromAbove(4);
    request.shadowCatcher = "floor";
    const std::vector<float> alpha = pictureOf(scene, request).channels.at(kAlphaChannel);
    // Independent noise would make half of the ratios less than 1.
    EXPECT_GT(std::ranges::count(alpha, 0.0F), 16 * 12 * 3 / 4);
    EXPECT_GT(std::ranges::count(alpha, 1.0F), 4) << "the board";
}

} // namespace
} // namespace stromboli

// Pictures of meshes that share their triangles: the kernel goes through placements, the reference
// has copies, and the two agree (z-tests with a family-wise error of 1e-4 a mode, fixed seeds). The
// kernel with copies makes nearly the same samples, and its bytes do not depend on how work is cut.
#include "host/core/random.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/layers.hpp"
#include "scene/generate/hard_meshes.hpp"
#include "scene/model/placements.hpp"
#include "tests/analytic/textured.hpp"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

/// A prototype of the mesh's triangles, which the scene then has first.
uint32_t addPrototype(Scene& scene, const Scene& mesh, uint32_t material) {
    const auto first = uint32_t(scene.triangles.size());
    const auto corner = uint32_t(scene.positions.size()), normal = uint32_t(scene.normals.size());
    for (Triangle t : mesh.triangles) {
        for (uint32_t& c : t.corner)
            c += corner;
        for (uint32_t& n : t.normals)
            if (n != kNoNormals) n += normal;
        t.material = material;
        scene.triangles.push_back(t);
    }
    scene.positions.insert(scene.positions.end(), mesh.positions.begin(), mesh.positions.end());
    scene.normals.insert(scene.normals.end(), mesh.normals.begin(), mesh.normals.end());
    scene.prototypes.push_back({first, uint32_t(mesh.triangles.size())});
    return uint32_t(scene.prototypes.size() - 1);
}

Scene smoothBall() {
    Scene ball = tessellatedSphere(6);
    ball.normals = ball.positions;
    for (Triangle& t : ball.triangles)
        std::copy_n(t.corner, 3, t.normals);
    return ball;
}

void place(Scene& scene, uint32_t prototype, const glm::dvec3& at, const glm::dvec3& scale,
           double turn) {
    glm::dmat4 m = glm::translate(glm::dmat4(1), at);
    m = glm::rotate(m, turn, glm::normalize(glm::dvec3(0.5, 1, 0.3)));
    Placement placement = *placementOf(glm::scale(m, scale));
    placement.prototype = prototype;
    placement.instance = uint32_t(scene.instances.size());
    scene.instances.push_back("placed");
    scene.placements.push_back(placement);
}

/// Stretched, mirrored and turned copies of a smooth ball with pictures, a normal map and a grain,
/// of a flat star that is partly not there, and of a glass one.
Scene placedRoom() {
    SceneMaker b;
    TextureMaker t(b.scene);
    Random random(5);
    std::vector<glm::vec4> noise, bumps;
    for (int i = 0; i < 64; ++i) {
        const auto u = [&] { return float(random.uniform()); };
        noise.emplace_back(u(), u(), u(), 0.2f + 0.8f * u());
        bumps.emplace_back(0.2f + 0.6f * u(), 0.2f + 0.6f * u(), 1, 1);
    }
    const uint32_t paper = t.texture({.image = t.bytes(8, 8, noise), .srgb = true});
    const uint32_t normals = t.texture(t.bytes(8, 8, bumps));
    const auto projected = [](const glm::vec3& p) {
        VertexAttributes a;
        a.uv[0] = glm::vec2(p.x + 0.3f * p.z, p.y);
        return a;
    };

    Material grained;
    grained.kind = MaterialKind::Principled;
    grained.principled = {.metallic = 0.6f, .roughness = 0.6f, .anisotropy = 0.6f};
    grained.textures = {{.slot = TextureSlot::BaseColor, .texture = paper},
                        {.slot = TextureSlot::Normal, .texture = normals, .scale = 0.5f}};
    const Scene ball = smoothBall();
    const uint32_t balls = addPrototype(b.scene, ball, b.add(grained));
    t.attributes(ball.triangles.size(), projected);
    Material veil = diffuse(0.7f);
    veil.alphaMode = AlphaMode::Blend;
    veil.textures = {{.slot = TextureSlot::BaseColor, .texture = paper},
                     {.slot = TextureSlot::Height, .texture = normals, .scale = 0.1f}};
    const Scene star = starMesh(1, random);
    const uint32_t stars = addPrototype(b.scene, star, b.add(veil));
    t.attributes(star.triangles.size(), projected);
    const uint32_t glasses = addPrototype(b.scene, starMesh(0, random), b.add(glass(1.5f)));
    t.attributes(0, {});

    place(b.scene, balls, {-0.45, -0.5, -0.2}, {0.35, 0.2, 0.3}, 0.7);
    place(b.scene, balls, {0.5, -0.6, -0.4}, {-0.3, 0.35, 0.25}, 2.1);
    place(b.scene, stars, {0.1, 0.1, -0.5}, {0.3, 0.3, 0.3}, 0.3);
    place(b.scene, stars, {0.2, 0.15, -0.4}, {0.25, -0.35, 0.3}, 1.3);
    place(b.scene, stars, {0.2, 0.15, -0.4}, {0.25, -0.35, 0.3}, 1.3); // in one place with the last
    place(b.scene, glasses, {-0.5, 0.3, -0.3}, {0.25, 0.25, -0.2}, 0.9);

    b.box({-1, -1, -1}, {1, 1, 1}, b.add(diffuse(0.7f)), true);
    b.quad({-0.4f, 0.95f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, b.add(emissive(8, false)));
    b.sphere({0.6f, -0.1f, 0.1f}, 0.15f, b.add(mirror(0.9f)));
    t.attributes(0, {});
    return b.scene;
}

RenderSettings instanceSettings(uint32_t samples) {
    RenderSettings s;
    s.area.width = 48, s.area.height = 40;
    s.budget.mostSamplesPerPixel = samples;
    s.estimator.maxBounces = 5;
    return s;
}

/// A picture that shows whether its bytes depend on how work is cut: a few hundred pixels, more
/// than the fewest lanes below, of some samples each. More would take longer where dispatches are
/// short.
RenderSettings cutInstanceSettings() {
    RenderSettings s = instanceSettings(4);
    s.area.width = 24, s.area.height = 20;
    s.estimator.branches = 2;
    return s;
}

Camera instanceCamera() {
    return lookingAt({0.3, 0.2, 0.95}, {-0.1, -0.2, -0.5}, 0.7);
}

struct InstanceMode {
    const char* name;
    void (*change)(RenderSettings&);
};
const InstanceMode kInstanceModes[] = {
    {"mis", [](RenderSettings&) {}},
    {"hemisphere", [](RenderSettings& s) { s.estimator.directLight = DirectLight::Hemisphere; }},
    {"branches",
     [](RenderSettings& s) { // 144 branches a pixel: more than other modes have paths
         s.estimator.branches = 3;
         s.budget.mostSamplesPerPixel /= 2;
     }},
    {"normals", [](RenderSettings& s) { s.estimator.integrator = Integrator::Normals; }},
};

class InstanceModes : public DeviceTest, public testing::WithParamInterface<InstanceMode> {};

TEST_P(InstanceModes, KernelAndReferenceAgree) {
    const Scene scene = placedRoom();
    RenderSettings s = instanceSettings(64);
    GetParam().change(s);
    expectKernelAndReferenceAgree(testDevice(), scene, instanceCamera(), s);
}

INSTANTIATE_TEST_SUITE_P(Modes, InstanceModes, testing::ValuesIn(kInstanceModes),
                         [](const auto& mode) { return mode.param.name; });

class Instances : public DeviceTest {};

/// Random numbers are those of pixel and sample: but for rounding, and for choices of opacity,
/// which depend on what is hit, the samples are the same.
TEST_F(Instances, AreAsCopies) {
    Scene scene = placedRoom();
    for (Material& m : scene.materials)
        m.alphaMode = AlphaMode::Opaque;
    const Film shared = renderOnDevice(testDevice(), scene, instanceCamera(), instanceSettings(4));
    const Film copied = renderOnDevice(testDevice(), expandPlacements(scene).scene,
                                       instanceCamera(), instanceSettings(4));
    size_t different = 0;
    for (size_t i = 0; i < shared.pixels.size(); ++i) {
        const glm::dvec3 a = shared.pixels[i].mean, b = copied.pixels[i].mean;
        different += glm::length(a - b) > 1e-3 * glm::length(a + b);
    }
    // A path in some hundreds is near enough to an edge to go another way.
    EXPECT_LT(double(different), 0.02 * double(shared.pixels.size()));
}

TEST_F(Instances, HaveTheSameBytesHoweverWorkIsCut) {
    const Scene scene = placedRoom();
    RenderSettings s = cutInstanceSettings();
    s.estimator.lightSamples = 2;
    const Film whole = renderOnDevice(testDevice(), scene, instanceCamera(), s);
    for (const KernelTuning& tuning :
         {KernelTuning{.fixedIterations = 1},
          {.lanes = 100, .fixedIterations = 50},
          {.workgroupSize = 24, .traversalSteps = 7, .traversalLegs = 2},
          {.traversalSteps = 3, .traversalLegs = 1},
          {.texelFetch = false},
          {.registerStack = 0}}) {
        const Film cut = renderOnDevice(testDevice(), scene, instanceCamera(), s, tuning);
        expectSameBytes(whole, cut);
    }
}

/// A ray passes by the triangle that it starts on, but not by the same triangle placed elsewhere:
/// here a roof, right above the floor of which it is the copy.
TEST_F(Instances, ShadeThemselves) {
    SceneMaker b;
    SceneMaker mesh;
    mesh.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);
    const uint32_t quads = addPrototype(b.scene, mesh.scene, b.add(diffuse(0.5f)));
    place(b.scene, quads, {0, 0, 0}, {1, 1, 1}, 0);
    place(b.scene, quads, {0, 0.5, 0}, {1, 1, 1}, 0);
    b.add(Light{.kind = LightKind::Directional, .color = {1, 1, 1}, .direction = {0, -1, 0}});
    RenderSettings s = instanceSettings(4);
    s.estimator.maxBounces = 1;
    const Camera underTheRoof = lookingAt({0.1, 0.25, 0.9}, {0, 0, 0}, 0.1);
    for (const PixelStatistics& pixel :
         renderOnDevice(testDevice(), b.scene, underTheRoof, s).pixels)
        ASSERT_EQ(pixel.mean, glm::dvec3(0));
    b.scene.placements.pop_back(), b.scene.instances.pop_back();
    for (const PixelStatistics& pixel :
         renderOnDevice(testDevice(), b.scene, underTheRoof, s).pixels)
        ASSERT_GT(pixel.mean.x, 0.1);
}

/// Surfaces at one distance are each met once, also where the same triangle is placed twice in one
/// place. False alarm below 1e-6 (5 standard errors of 7680 samples).
TEST_F(Instances, InOnePlaceAreEachPassed) {
    SceneMaker b;
    SceneMaker mesh;
    mesh.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    Material veil = diffuse(0);
    veil.alphaMode = AlphaMode::Blend;
    veil.opacity = 0.5f;
    const uint32_t quads = addPrototype(b.scene, mesh.scene, b.add(veil));
    place(b.scene, quads, {0, 0, 0}, {1, 1, 1}, 0);
    place(b.scene, quads, {0, 0, 0}, {1, 1, 1}, 0);
    b.quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}, b.add(emissive(1)));
    const Camera ahead = lookingAt({0.1, 0.2, 2}, {0, 0, 0}, 0.1);
    double sum = 0;
    const Film film = renderOnDevice(testDevice(), b.scene, ahead, instanceSettings(4));
    for (const PixelStatistics& pixel : film.pixels)
        sum += pixel.mean.x;
    EXPECT_NEAR(sum / double(film.pixels.size()), 0.25, 0.025);
}

/// Layers of a picture with one camera ray a pixel.
FloatImage layersBy(Viewer& viewer, const Scene& scene, const PictureArea& area) {
    FloatImage image(area);
    const std::vector<uint32_t> samples(area.pixelCount(), 1);
    addLayers(image, {Layer::Object, Layer::Material, Layer::Uv, Layer::Normal}, 0,
              viewer.see(0, samples, Seeing::Surfaces), scene, instanceCamera());
    return image;
}

/// How many numbers of a channel are other ones.
size_t differences(const std::vector<float>& a, const std::vector<float>& b) {
    size_t different = 0;
    for (size_t i = 0; i < a.size(); ++i)
        different += !(std::abs(a[i] - b[i]) <= 2e-3f);
    return different;
}

/// What layers say of them, each its own object, is what they say of copies.
TEST_F(Instances, AreSeenAsCopiesAre) {
    Scene scene = placedRoom();
    for (Material& m : scene.materials)
        m.alphaMode = AlphaMode::Opaque; // or it would be a matter of random numbers
    scene.placements.erase(scene.placements.begin() + 4); // or which of two in one place is met
    const Scene copies = expandPlacements(scene).scene;
    const RenderSettings s = instanceSettings(1);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    const GpuScene gpuCopies = packScene(copies, buildWideBvh(copies), lightSelection(s.estimator));
    VulkanBackend device(testDevice(), gpu, instanceCamera(), s);
    VulkanBackend deviceCopies(testDevice(), gpuCopies, instanceCamera(), s);
    ReferenceBackend host(scene, instanceCamera(), s), hostCopies(copies, instanceCamera(), s);
    const FloatImage seen = layersBy(device, scene, s.area);
    const FloatImage seenCopies = layersBy(deviceCopies, copies, s.area);
    const FloatImage onHost = layersBy(host, scene, s.area);
    const FloatImage onHostCopies = layersBy(hostCopies, copies, s.area);
    for (const auto& [name, values] : seen.channels) {
        // Some pixels show an edge, where rounding decides.
        EXPECT_LT(differences(values, seenCopies.channels.at(name)), values.size() / 50) << name;
        EXPECT_EQ(differences(onHost.channels.at(name), onHostCopies.channels.at(name)), 0u)
            << name;
    }
    // Six placements, the walls, the emitter and the mirror have names from the 1st on.
    const std::vector<float>& objects = seen.channels.at("object.X");
    for (float object = 1; object <= 6; ++object)
        EXPECT_GT(std::ranges::count(objects, object), object == 5 ? -1 : 3) << object;
    EXPECT_EQ(std::ranges::count(objects, 5.0f), 0);
}

} // namespace
} // namespace stromboli

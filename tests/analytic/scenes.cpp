#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {

uint32_t SceneBuilder::add(const Material& material) {
    scene.materials.push_back(material);
    return uint32_t(scene.materials.size() - 1);
}

void SceneBuilder::startInstance() {
    scene.instances.push_back("instance " + std::to_string(scene.instances.size()));
}

void SceneBuilder::triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                            uint32_t material) {
    if (scene.instances.empty()) startInstance();
    Triangle t;
    for (int i = 0; i < 3; ++i)
        t.corner[i] = uint32_t(scene.positions.size()) + i;
    t.material = material;
    t.instance = uint32_t(scene.instances.size() - 1);
    for (const glm::vec3& p : {a, b, c})
        scene.positions.push_back(p);
    scene.triangles.push_back(t);
}

void SceneBuilder::addQuad(const glm::vec3& corner, const glm::vec3& edgeA, const glm::vec3& edgeB,
                           uint32_t material) {
    triangle(corner + edgeB, corner, corner + edgeA, material);
    triangle(corner + edgeA, corner + edgeA + edgeB, corner + edgeB, material);
}

void SceneBuilder::quad(const glm::vec3& corner, const glm::vec3& edgeA, const glm::vec3& edgeB,
                        uint32_t material) {
    startInstance();
    addQuad(corner, edgeA, edgeB, material);
}

void SceneBuilder::room(const glm::vec3& lo, const glm::vec3& hi, uint32_t material) {
    startInstance();
    const glm::vec3 e = hi - lo, x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
    addQuad(lo, x, y, material);
    addQuad(lo, y, z, material);
    addQuad(lo, z, x, material);
    addQuad(hi, -y, -x, material);
    addQuad(hi, -z, -y, material);
    addQuad(hi, -x, -z, material);
}

void SceneBuilder::sphere(const glm::vec3& center, float radius, uint32_t material) {
    startInstance();
    Sphere s;
    s.center = center, s.radius = radius, s.material = material;
    s.instance = uint32_t(scene.instances.size() - 1);
    scene.spheres.push_back(s);
}

Material diffuse(float albedo, float emission) {
    Material m;
    m.albedo = glm::vec3(albedo);
    m.emission = glm::vec3(emission);
    return m;
}

Material lamp(float radiance, bool bothSides) {
    Material m = diffuse(0, radiance);
    m.emitsBothSides = bothSides;
    return m;
}

Material glass(float ior) {
    Material m;
    m.kind = MaterialKind::Glass;
    m.ior = ior;
    return m;
}

void addFloor(SceneBuilder& builder, uint32_t material) {
    builder.quad({-10, 0, -10}, {0, 0, 20}, {20, 0, 0}, material);
}

Scene cornellBox() {
    SceneBuilder b;
    Material red = diffuse(0.7f);
    red.albedo = {0.7f, 0.3f, 0.2f};
    b.room({0, 0, 0}, {1, 1, 1}, b.add(red));
    b.quad({0.3f, 0.99f, 0.3f}, {0.4f, 0, 0}, {0, 0, 0.4f}, b.add(lamp(10, false)));
    Material mirror;
    mirror.kind = MaterialKind::Mirror;
    mirror.reflectance = glm::vec3(0.9f);
    b.sphere({0.3f, 0.25f, 0.3f}, 0.2f, b.add(mirror));
    b.sphere({0.7f, 0.25f, 0.6f}, 0.2f, b.add(glass(1.5f)));
    Material metal;
    metal.kind = MaterialKind::Microfacet;
    metal.alpha = 0.3f, metal.eta = {1.3f, 1.0f, 0.7f}, metal.k = {7.3f, 6.6f, 5.6f};
    b.quad({0.1f, 0.5f, 0.1f}, {0.5f, 0, 0}, {0, 0.4f, 0.1f}, b.add(metal));
    return b.scene;
}

Camera pointCamera(const glm::dvec3& from, const glm::dvec3& at, double halfWidth) {
    Camera camera;
    camera.position = from;
    camera.back = glm::normalize(from - at);
    const glm::dvec3 up = std::abs(camera.back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    camera.right = glm::normalize(glm::cross(up, camera.back));
    camera.up = glm::cross(camera.back, camera.right);
    camera.halfWidth = camera.halfHeight = halfWidth;
    return camera;
}

RenderSettings smallPicture(uint32_t samplesPerPixel, uint32_t maxBounces) {
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.samplesPerPixel = samplesPerPixel;
    settings.maxBounces = maxBounces;
    settings.roulette.mode = Roulette::Mode::None;
    return settings;
}

Estimate estimate(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    PixelStatistics all;
    for (const PixelStatistics& pixel : renderFilm(scene, camera, settings).pixels)
        all.merge(pixel);
    EXPECT_EQ(all.rejected, 0u);
    return {all.mean, glm::sqrt(all.varianceOfMean())};
}

void expectMean(const Estimate& found, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c],
                    4.5 * found.error[c] + kRounding * std::abs(expected[c]))
            << "channel " << c << ", standard error " << found.error[c];
}

void expectMean(const Estimate& found, double expected) {
    expectMean(found, glm::dvec3(expected));
}

void expectSameMean(const Estimate& a, const Estimate& b) {
    expectMean({a.mean, glm::sqrt(a.error * a.error + b.error * b.error)}, b.mean);
}

} // namespace stromboli::test

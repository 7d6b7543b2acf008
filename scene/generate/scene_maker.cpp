#include "scene/generate/scene_maker.hpp"

#include <string>

namespace stromboli::scenes {

uint32_t SceneMaker::add(const Material& material) {
    scene.materials.push_back(material);
    return uint32_t(scene.materials.size() - 1);
}

uint32_t SceneMaker::add(const Medium& medium) {
    scene.media.push_back(medium);
    return uint32_t(scene.media.size() - 1);
}

void SceneMaker::startInstance() {
    scene.instances.push_back("instance " + std::to_string(scene.instances.size()));
}

void SceneMaker::triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                          uint32_t material) {
    if (scene.instances.empty()) startInstance();
    const auto first = uint32_t(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {a, b, c});
    Triangle& t = scene.triangles.emplace_back();
    for (uint32_t i = 0; i < 3; ++i)
        t.corner[i] = first + i;
    t.material = material;
    t.instance = uint32_t(scene.instances.size() - 1);
}

void SceneMaker::addFace(const std::array<glm::vec3, 4>& corners, uint32_t material) {
    const auto first = uint32_t(scene.positions.size());
    scene.positions.insert(scene.positions.end(), corners.begin(), corners.end());
    for (const uint32_t i : {1u, 2u}) {
        Triangle& t = scene.triangles.emplace_back();
        t.corner[0] = first, t.corner[1] = first + i, t.corner[2] = first + i + 1;
        t.material = material;
        t.instance = uint32_t(scene.instances.size() - 1);
    }
}

void SceneMaker::quad(const glm::vec3& corner, const glm::vec3& edgeA, const glm::vec3& edgeB,
                      uint32_t material) {
    startInstance();
    addFace({corner, corner + edgeA, corner + edgeA + edgeB, corner + edgeB}, material);
}

void SceneMaker::box(const glm::vec3& lo, const glm::vec3& hi, uint32_t material, bool inwards) {
    startInstance();
    for (int k = 0; k < 3; ++k)
        for (const bool high : {false, true}) {
            // Taken from lo and hi, not summed: the box is closed to the last bit.
            const auto corner = [&](bool a, bool b) {
                glm::vec3 p;
                p[k] = (high ? hi : lo)[k];
                p[(k + 1) % 3] = (a ? hi : lo)[(k + 1) % 3];
                p[(k + 2) % 3] = (b ? hi : lo)[(k + 2) % 3];
                return p;
            };
            if (high != inwards)
                addFace({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}, material);
            else
                addFace({corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)}, material);
        }
}

void SceneMaker::sphere(const glm::vec3& center, float radius, uint32_t material) {
    startInstance();
    Sphere& s = scene.spheres.emplace_back();
    s.center = center, s.radius = radius, s.material = material;
    s.instance = uint32_t(scene.instances.size() - 1);
}

Material diffuse(float albedo, float emission) {
    Material m;
    m.albedo = glm::vec3(albedo);
    m.emission = glm::vec3(emission);
    return m;
}

Material mirror(float reflectance, float emission) {
    Material m;
    m.kind = MaterialKind::Mirror;
    m.reflectance = glm::vec3(reflectance);
    m.emission = glm::vec3(emission);
    return m;
}

Material glass(float ior) {
    Material m;
    m.kind = MaterialKind::Dielectric;
    m.ior = ior;
    return m;
}

Material metal(float alpha, float emission) {
    Material m;
    m.kind = MaterialKind::Conductor;
    m.facets = {FacetDistribution::Beckmann, glm::vec2(alpha)};
    m.eta = glm::vec3(1.2f);
    m.k = glm::vec3(3);
    m.emission = glm::vec3(emission);
    return m;
}

Material emissive(float radiance, bool bothSides) {
    Material m = diffuse(0, radiance);
    m.emitsBothSides = bothSides;
    return m;
}

Medium mediumOf(const glm::vec3& absorption, const glm::vec3& scattering, float asymmetry) {
    Medium m;
    m.absorption = absorption;
    m.scattering = scattering;
    m.asymmetry = asymmetry;
    return m;
}

Material border(uint32_t inside, uint32_t outside) {
    Material m = diffuse(0);
    m.alphaMode = AlphaMode::Blend;
    m.opacity = 0;
    m.boundsMedia = true;
    m.inside = inside;
    m.outside = outside;
    return m;
}

Light ambient(float radiance) {
    Light light;
    light.kind = LightKind::Ambient;
    light.color = glm::vec3(radiance);
    return light;
}

Scene cornellBox() {
    SceneMaker m;
    Material walls = diffuse(0.7f);
    walls.albedo = {0.7f, 0.3f, 0.2f};
    m.box({0, 0, 0}, {1, 1, 1}, m.add(walls), true);
    m.quad({0.3125f, 0.984375f, 0.3125f}, {0.375f, 0, 0}, {0, 0, 0.375f},
           m.add(emissive(10, false)));
    m.sphere({0.3125f, 0.25f, 0.3125f}, 0.1875f, m.add(mirror(0.9f)));
    m.sphere({0.6875f, 0.25f, 0.625f}, 0.1875f, m.add(glass(1.5f)));
    m.quad({0.125f, 0.5f, 0.125f}, {0.5f, 0, 0}, {0, 0.375f, 0.125f}, m.add(metal(0.3f)));
    return m.scene;
}

} // namespace stromboli::scenes

// Principled materials in pictures: white furnaces, absorption in a slab against its closed form,
// and light on both sides of rough glass, which every way of finding light finds alike.
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

Material principled(float metallic, float roughness) {
    Material m;
    m.kind = MaterialKind::Principled;
    m.principled.metallic = metallic;
    m.principled.roughness = roughness;
    return m;
}

Material roughGlass(float roughness, bool thin, float ior = 1.5f) {
    Material m = principled(0, roughness);
    m.principled.transmission = 1;
    m.principled.isThin = thin;
    m.principled.ior = ior;
    return m;
}

TEST(Principled, WhiteMaterialsKeepTheLight) {
    for (const float roughness : {0.0f, 0.25f, 0.6f, 1.0f})
        for (const float metallic : {0.0f, 1.0f})
            for (const DirectLight direct : {DirectLight::Mis, DirectLight::Bsdf}) {
                RenderSettings s = smallPicture(16, 20);
                s.estimator.directLight = direct;
                const Material m = principled(metallic, roughness);
                const Estimate found = estimate(sphereInAmbientLight(m), kOutside, s);
                EXPECT_NEAR(found.mean.x, 1, kFits + 4.5 * found.error.x)
                    << roughness << ' ' << metallic << ' ' << nameOf(direct);
            }
}

TEST(Principled, ThinWhiteGlassKeepsTheLight) {
    for (const float roughness : {0.0f, 0.3f, 1.0f})
        for (const DirectLight direct : {DirectLight::Mis, DirectLight::Bsdf}) {
            RenderSettings s = smallPicture(16, 200);
            s.estimator.directLight = direct;
            const Estimate found =
                estimate(sphereInAmbientLight(roughGlass(roughness, true)), kOutside, s);
            // Some ten times through the sheet.
            EXPECT_NEAR(found.mean.x, 1, 4 * kFits + 4.5 * found.error.x) << roughness;
        }
}

/// A path that leaves again has met the factor eta^2 on its way in and its inverse on its way out.
/// What rough facets would scatter again is lost, and nothing where it is smooth.
TEST(Principled, WhiteGlassLosesLittleWhereItIsNearlySmooth) {
    for (const float roughness : {0.0f, 0.2f}) {
        const Estimate found = estimate(sphereInAmbientLight(roughGlass(roughness, false)),
                                        kOutside, smallPicture(64, 200));
        constexpr double kRounding = 64 * 0x1p-24; // of the factors of a path through the ball
        EXPECT_LT(found.mean.x, 1 + kRounding + 4.5 * found.error.x);
        EXPECT_GT(found.mean.x, 0.985 - 4.5 * found.error.x) << roughness;
    }
}

/// A wide slab, seen at a right angle in light 1 from everywhere: with the reflectance R of a face
/// and the transmittance A of the inside, R + (1 - R)^2 A / (1 - R A).
TEST(Principled, SlabAbsorbsByBeerAndLambert) {
    const glm::dvec3 color(0.8, 0.3, 1.0);
    const double thickness = 0.7, distance = 0.5;
    for (const float ior : {1.0f, 1.5f}) {
        Material m = roughGlass(0, false, ior);
        m.principled.attenuationColor = color;
        m.principled.attenuationDistance = float(distance);
        SceneMaker b;
        b.box({-100, -100, -float(thickness)}, {100, 100, 0}, b.add(m));
        b.add(ambient(1));
        const Camera camera = pointCamera({0.3, 0.2, 2}, {0.3, 0.2, 0});
        const double r = std::pow((ior - 1.0) / (ior + 1.0), 2);
        glm::dvec3 expected;
        for (int c = 0; c < 3; ++c) {
            const double a = std::pow(color[c], thickness / distance);
            expected[c] = r + (1 - r) * (1 - r) * a / (1 - r * a);
        }
        for (const DirectLight direct : {DirectLight::Mis, DirectLight::Bsdf}) {
            RenderSettings s = smallPicture(64, 60);
            s.estimator.directLight = direct;
            const Estimate found = estimate(b.scene, camera, s);
            for (int c = 0; c < 3; ++c) // 1e-3: white is reflected at the fitted albedo
                EXPECT_NEAR(found.mean[c], expected[c], 4.5 * found.error[c] + 1e-3)
                    << ior << ' ' << c << ' ' << nameOf(direct);
        }
    }
}

/// Rough glass between the camera and some lights, with others on the camera's side.
Scene litFromBothSides(const Material& material, bool inside) {
    SceneMaker b;
    const uint32_t glass = b.add(material), light = b.add(emissive(8)),
                   floor = b.add(diffuse(0.6f));
    b.box({-1, -1, -0.4f}, {1, 1, 0}, glass);
    b.quad({-0.5f, -0.5f, -2}, {1, 0, 0}, {0, 1, 0}, light);
    b.sphere({1.5f, 1, 1.5f}, 0.4f, light);
    if (inside) b.sphere({0.3f, -0.2f, -0.2f}, 0.1f, light);
    b.quad({-4, -1.2f, -4}, {0, 0, 8}, {8, 0, 0}, floor);
    return b.scene;
}

const Camera kInFront = pointCamera({0.4, 0.3, 4}, {0.1, 0, 0}, 0.15);

TEST(Principled, LightOnBothSidesIsFoundAlikeInEveryWay) {
    for (const bool thin : {true, false})
        for (const float roughness : {0.45f, 0.8f}) {
            if (thin && roughness > 0.5f) continue;
            Material m = roughGlass(roughness, thin);
            m.principled.baseColor = {0.9f, 0.7f, 0.5f};
            m.principled.attenuationColor = {0.5f, 0.9f, 0.2f};
            m.principled.attenuationDistance = 0.3f;
            m.principled.transmission = 0.8f;
            const Scene scene = litFromBothSides(m, !thin);
            RenderSettings s = smallPicture(256, 4);
            s.estimator.directLight = DirectLight::Bsdf;
            const Estimate byBounces = estimate(scene, kInFront, s);
            for (const DirectLight direct : {DirectLight::Lights, DirectLight::Mis,
                                             DirectLight::MisAll, DirectLight::Hemisphere}) {
                if (!isAnotherWay(direct)) continue;
                s.estimator.directLight = direct;
                SCOPED_TRACE(std::string(nameOf(direct)) + (thin ? " thin" : " volume"));
                expectSameMean(estimate(scene, kInFront, s), byBounces);
            }
        }
}

/// For branches and two light samples, which take other random numbers, the mean is the same.
TEST(Principled, BranchesAndLightSamplesLeaveTheMean) {
    Material m = roughGlass(0.5f, false);
    m.principled.attenuationColor = {0.5f, 0.9f, 0.2f};
    m.principled.attenuationDistance = 0.3f;
    const Scene scene = litFromBothSides(m, true);
    RenderSettings s = smallPicture(400, 5);
    const Estimate plain = estimate(scene, kInFront, s);
    s.estimator.branches = 4;
    s.estimator.lightSamples = 2;
    s.budget.mostSamplesPerPixel = 100;
    expectSameMean(estimate(scene, kInFront, s), plain);
}

/// A lamp that no bounce can find, behind a sheet whose facets send light on as a mirror image: the
/// irradiance on the sheet times its BSDF, thin and of the greatest roughness.
TEST(Principled, PointLightShinesThroughAThinSheet) {
    SceneMaker b;
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, b.add(roughGlass(1, true, 1.0f)));
    Light light;
    light.kind = LightKind::Point;
    light.position = {0, 0, -2};
    light.color = glm::vec3(1);
    light.constantAttenuation = 0, light.quadraticAttenuation = 1;
    b.add(light);
    const Camera camera = pointCamera({0, 0, 3}, {0, 0, 0});
    // Seen and lit at right angles: f = D(n) G2 / 4 / albedo = 1 / (4 pi albedo), irradiance 1 / 4.
    // The directional albedo of GGX of alpha 1 at a right angle is 1 - ln 2 (tests/reference).
    const double albedo = 1 - std::log(2.0);
    const Estimate found = estimate(b.scene, camera, smallPicture(16, 1));
    EXPECT_NEAR(found.mean.x, 1 / (4 * 3.14159265 * albedo) / 4, 0.005 * found.mean.x);
}

} // namespace
} // namespace stromboli

// Diffuse transmission, dispersion and thin films of principled materials in pictures, against
// closed forms and an integral over the spectrum.
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace stromboli {
namespace {

using namespace test;

constexpr double kPi = 3.14159265358979323846;

Material principled(float roughness) {
    Material m;
    m.kind = MaterialKind::Principled;
    m.principled.metallic = 0;
    m.principled.roughness = roughness;
    return m;
}

Scene sphereInAmbientLight(const Material& material) {
    SceneMaker b;
    b.sphere({0, 0, 0}, 1, b.add(material));
    b.add(ambient(1));
    return b.scene;
}

const Camera kOutside = pointCamera({0, 0, 4}, {0, 0, 0}, 0.18); // the sphere fills the picture

// --- Diffuse transmission ------------------------------------------------------------------------

/// Without a layer that reflects: of colour 1 to the other side, 0.5 to this one.
Material leaf(float share, bool isThin) {
    Material m = principled(1);
    m.principled.specular = 0;
    m.principled.baseColor = glm::vec3(0.5f);
    m.principled.diffuseTransmission = share;
    m.principled.diffuseTransmissionColor = {1, 0.75f, 0.25f};
    m.principled.isThin = isThin;
    return m;
}

TEST(DiffuseTransmission, WhiteMaterialsKeepTheLight) {
    for (const bool isThin : {true, false})
        for (const float roughness : {0.2f, 0.7f}) {
            Material m = principled(roughness);
            m.principled.diffuseTransmission = 0.7f;
            m.principled.isThin = isThin;
            // Some ten times through the surface.
            const Estimate found =
                estimate(sphereInAmbientLight(m), kOutside, smallPicture(32, 200));
            EXPECT_NEAR(found.mean.x, 1, 4 * kFits + 4.5 * found.error.x) << isThin << roughness;
        }
}

/// A lamp at right angles, two metres away: an irradiance of 1/4, and Lambert's law on either side.
TEST(DiffuseTransmission, LampsShineThroughByLambertsLaw) {
    for (const float z : {-2.0f, 2.0f}) {
        SceneMaker b;
        b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, b.add(leaf(0.6f, true)));
        Light light;
        light.kind = LightKind::Point;
        light.position = {0, 0, z};
        light.color = glm::vec3(1);
        light.constantAttenuation = 0, light.quadraticAttenuation = 1;
        b.add(light);
        const glm::dvec3 through = 0.6 * glm::dvec3(1, 0.75, 0.25);
        const glm::dvec3 albedo = z < 0 ? through : glm::dvec3(0.4 * 0.5);
        const Estimate found =
            estimate(b.scene, pointCamera({0.1, 0, 3}, {0, 0, 0}), smallPicture(16, 1));
        for (int c = 0; c < 3; ++c) // shares and colours are floats
            EXPECT_NEAR(found.mean[c], albedo[c] / kPi / 4, 1e-6 + 4.5 * found.error[c]);
    }
}

/// A wide slab in light 1 from everywhere. Of light that a face sends inside by Lambert's law the
/// share 2 E3(x) meets the other one, x being the optical depth; a face lets T through and sends R
/// back.
TEST(DiffuseTransmission, SlabAbsorbsWhatGoesThrough) {
    const double depth = 0.8, attenuation = 0.3;
    Material m = leaf(0.75f, false);
    m.principled.attenuationColor = glm::vec3(float(attenuation));
    m.principled.attenuationDistance = 1;
    SceneMaker b;
    b.box({-100, -100, -float(depth)}, {100, 100, 0}, b.add(m));
    b.add(ambient(1));
    const double x = -std::log(attenuation) * depth;
    const double e1 = -std::expint(-x), e2 = std::exp(-x) - x * e1;
    const double between = std::exp(-x) - x * e2; // 2 E3
    glm::dvec3 expected;
    for (int c = 0; c < 3; ++c) {
        const double t = 0.75 * double(m.principled.diffuseTransmissionColor[c]), r = 0.25 * 0.5;
        expected[c] = r + t * t * between / (1 - r * between);
    }
    const Estimate found =
        estimate(b.scene, pointCamera({0.3, 0.2, 2}, {0.3, 0.2, 0}), smallPicture(400, 60));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c], 4.5 * found.error[c] + 1e-5) << c;
}

/// Lamps on both sides of a slab and inside it.
TEST(DiffuseTransmission, LightIsFoundAlikeInEveryWay) {
    Material m = leaf(0.6f, false);
    m.principled.specular = 1, m.principled.roughness = 0.5f, m.principled.transmission = 0.3f;
    m.principled.attenuationColor = {0.5f, 0.9f, 0.2f};
    m.principled.attenuationDistance = 0.3f;
    SceneMaker b;
    const uint32_t wax = b.add(m), light = b.add(emissive(8));
    b.box({-1, -1, -0.4f}, {1, 1, 0}, wax);
    b.quad({-0.5f, -0.5f, -2}, {1, 0, 0}, {0, 1, 0}, light);
    b.sphere({1.5f, 1, 1.5f}, 0.4f, light);
    b.sphere({0.3f, -0.2f, -0.2f}, 0.1f, light);
    const Camera camera = pointCamera({0.4, 0.3, 4}, {0.1, 0, 0}, 0.15);
    RenderSettings s = smallPicture(144, 4);
    s.estimator.directLight = DirectLight::Bsdf;
    const Estimate byBounces = estimate(b.scene, camera, s);
    for (const DirectLight direct : {DirectLight::Lights, DirectLight::Hemisphere}) {
        s.estimator.directLight = direct;
        SCOPED_TRACE(nameOf(direct));
        expectSameMean(estimate(b.scene, camera, s), byBounces);
    }
}

// --- Dispersion ----------------------------------------------------------------------------------

/// Of the Abbe number 10: the indices are 1.475, 1.5 and 1.525.
Material prism(float roughness) {
    Material m = principled(roughness);
    m.principled.transmission = 1;
    m.principled.isThin = false;
    m.principled.dispersion = 2;
    return m;
}
const glm::dvec3 kIndices(1.475, 1.5, 1.525);

TEST(Dispersion, RadianceInsideIsLargerByTheSquareOfEachIndex) {
    const Camera center = pointCamera({0, 0, 0}, {0, 0, 1}, 0.5);
    const Estimate found = estimate(sphereInAmbientLight(prism(0)), center, smallPicture(256, 200));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], kIndices[c] * kIndices[c], 4.5 * found.error[c] + 1e-3) << c;
}

TEST(Dispersion, WhiteGlassLosesLittle) {
    for (const float roughness : {0.0f, 0.2f}) {
        const Estimate found =
            estimate(sphereInAmbientLight(prism(roughness)), kOutside, smallPicture(64, 200));
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(found.mean[c], 1 + 4.5 * found.error[c]) << c;
            EXPECT_GT(found.mean[c], 0.985 - 4.5 * found.error[c]) << c;
        }
    }
}

/// Snell's law: seen at 60 degrees, half a metre below the surface, colours are at 0.5 tan of their
/// angles. A lamp there begins between two of them.
TEST(Dispersion, EachColorGoesWhereItsIndexSendsIt) {
    const double sine = std::sqrt(0.75), cosine = 0.5;
    glm::dvec3 place, seen;
    for (int c = 0; c < 3; ++c) {
        const double n = kIndices[c], s = sine / n, inside = std::sqrt(1 - s * s);
        place[c] = 0.5 * s / inside;
        const double rs = (cosine - n * inside) / (cosine + n * inside);
        const double rp = (n * cosine - inside) / (n * cosine + inside);
        // The Fresnel term of this index, from that of 1.5 at normal incidence to 1.
        const double exact = (rs * rs + rp * rp) / 2, normal = std::pow((n - 1) / (n + 1), 2);
        seen[c] = (1 - 0.04) * (1 - (exact - normal) / (1 - normal)) / (n * n);
    }
    for (int first = 0; first < 2; ++first) { // blue is bent most, red least
        SceneMaker b;
        b.box({-4, -4, -1}, {4, 4, 0}, b.add(prism(0)));
        const float edge = float((place[first] + place[first + 1]) / 2);
        b.quad({edge, -2, -0.5f}, {3 - edge, 0, 0}, {0, 4, 0}, b.add(emissive(1, false)));
        const Camera camera = pointCamera({-4 * sine, 0, 4 * cosine}, {0, 0, 0});
        RenderSettings s = smallPicture(256, 8);
        s.estimator.directLight = first == 0 ? DirectLight::Mis : DirectLight::Bsdf;
        const Estimate found = estimate(b.scene, camera, s);
        for (int c = 0; c < 3; ++c) // 1e-3: tails of the facets' distribution
            EXPECT_NEAR(found.mean[c], c <= first ? seen[c] : 0, 4.5 * found.error[c] + 1e-3)
                << first << ' ' << c;
    }
}

// --- Thin films ----------------------------------------------------------------------------------

/// Reflectance of a film between air and a surface of these indices, at normal incidence, for the
/// wave number k per metre: Airy's sum of all reflections, as amplitudes.
double airy(double film, double surface, double thickness, double k) {
    const double r12 = (1 - film) / (1 + film), r23 = (film - surface) / (film + surface);
    const std::complex<double> turn = std::polar(1.0, 2 * kPi * k * 2 * film * thickness);
    return std::norm((r12 + r23 * turn) / (1.0 + r12 * r23 * turn));
}

/// By channel, integrated over the eye's curves (Belcour and Barla 2017): Gaussians over the wave
/// number, so many standard deviations to either side. The mean over all phases is white.
glm::dvec3 filmColor(double film, double surface, double thickness) {
    struct Curve {
        int number;
        double area, center, variance;
    };
    constexpr Curve curves[] = {{0, 5.4856e-13, 1.6810e6, 4.3278e9},
                                {0, 9.7470e-14, 2.2399e6, 4.5282e9},
                                {1, 4.4201e-13, 1.7953e6, 9.3046e9},
                                {2, 5.2481e-13, 2.2084e6, 6.6121e9}};
    const double r12 = std::pow((1 - film) / (1 + film), 2);
    const double r23 = std::pow((film - surface) / (film + surface), 2);
    const double white = r12 + (1 - r12) * (1 - r12) * r23 / (1 - r12 * r23);
    glm::dvec3 xyz(0.0);
    for (const Curve& c : curves) {
        const double deviation = std::sqrt(2 * c.variance), step = deviation / 50;
        double sum = 0;
        for (int i = -400; i <= 400; ++i) {
            const double weight = std::exp(-0.5 * std::pow(i * step / deviation, 2));
            sum += weight * (airy(film, surface, thickness, c.center + i * step) - white);
        }
        const double whole = std::sqrt(2 * kPi * c.variance) * c.area / 1.0685e-7;
        xyz[c.number] += whole * sum * step / (std::sqrt(2 * kPi) * deviation);
    }
    const glm::dmat3 rgb({3.2404542, -0.9692660, 0.0556434}, {-1.5371385, 1.8760108, -0.2040259},
                         {-0.4985314, 0.0415560, 1.0572252});
    return white + rgb * xyz;
}

/// A metal without roughness, seen at a right angle.
TEST(ThinFilm, ColorsAreThoseOfTheSpectrum) {
    const double f0 = 0.5, surface = (1 + std::sqrt(f0)) / (1 - std::sqrt(f0));
    glm::dvec3 last(0.0);
    for (const float thickness : {200.0f, 300.0f, 550.0f}) {
        Material m = principled(0);
        m.principled.metallic = 1;
        m.principled.baseColor = glm::vec3(float(f0));
        m.principled.iridescence = 1;
        m.principled.filmIor = 1.4f;
        m.principled.filmThickness = 100, m.principled.filmSpan = thickness - 100;
        SceneMaker b;
        b.quad({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, b.add(m));
        b.add(ambient(1));
        const Estimate found =
            estimate(b.scene, pointCamera({0, 0, 3}, {0, 0, 0}), smallPicture(64, 2));
        const glm::dvec3 expected = filmColor(1.4, surface, thickness * 1e-9);
        // Of the spectral sum, two orders: a third one is below 2 (r12 r23)^(3/2) (1 - r12).
        const double r12 = 0.0278, r23 = std::pow((surface - 1.4) / (surface + 1.4), 2);
        const double thirdOrder = 2 * std::pow(r12 * r23, 1.5) * 1.5;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.mean[c], expected[c],
                        kFits * expected[c] + thirdOrder + 4.5 * found.error[c])
                << thickness << ' ' << c;
        EXPECT_GT(glm::length(expected - last), 0.1); // the colours differ
        last = expected;
    }
}

/// What film and surface reflect, a fifth and more, does not come to the diffuse base.
TEST(ThinFilm, NoLightIsGained) {
    for (const float roughness : {0.1f, 1.0f}) {
        Material m = principled(roughness);
        m.principled.iridescence = 1;
        m.principled.ior = 2.5f, m.principled.filmIor = 1.3f;
        m.principled.filmThickness = 400;
        const Estimate found = estimate(sphereInAmbientLight(m), kOutside, smallPicture(32, 100));
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(found.mean[c], 1 + kFits + 4.5 * found.error[c]) << roughness;
            EXPECT_GT(found.mean[c], 0.7) << roughness;
        }
    }
}

} // namespace
} // namespace stromboli

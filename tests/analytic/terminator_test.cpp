// Smooth low-poly meshes: light falls off as on the smooth surface that their normals speak of, not
// in steps of the shape of their facets, and none of it is lost where shading and geometric normal
// disagree.
#include "tests/analytic/smooth_mesh.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

using namespace test;

constexpr double kAlbedo = 0.5; ///< a float, too

// --- Scan lines across the terminator ----------------------------------------------------------

/// To a parallel light at the right of the viewer and above: the terminator runs across the left
/// half of the sphere, over facets at all angles to it.
const glm::dvec3 kToLight = glm::normalize(glm::dvec3(0.85, 0.2, 0.5));
constexpr uint32_t kPixels = 400;
constexpr double kHalfWidth = 1.1, kPixelWidth = 2 * kHalfWidth / kPixels;

/// Radiance along a line of pixels.
struct ScanLine {
    std::vector<double> found;
    std::vector<double> least, most; ///< of the smooth closed form within the pixel
    std::vector<double> naive;       ///< the mean of what light from a flat facet gives
    std::vector<double> facing; ///< least cosine of the view to the facet; 0: not all of it hit
};

/// What the interpolated normal says: albedo / pi times its cosine to the light.
double smoothRadiance(const MeshPoint& p) {
    return kAlbedo / kPi * std::max(glm::dot(p.shading, kToLight), 0.0);
}

ScanLine scan(const Scene& scene, double y, bool offsets = true) {
    Camera camera;
    camera.orthographic = true;
    camera.position = {0, y, 5};
    camera.halfWidth = kHalfWidth, camera.halfHeight = 1e-9;
    RenderSettings s = smallPicture(16, 1);
    s.area.width = kPixels, s.area.height = 1;
    s.estimator.conventions.offsetsTerminator = offsets;
    const Film film = renderFilm(scene, camera, s);
    ScanLine line;
    for (uint32_t i = 0; i < kPixels; ++i) {
        constexpr int kParts = 8;
        double least = 1, most = 0, naive = 0, facing = 1;
        for (int k = 0; k <= kParts; ++k) {
            const double x = -kHalfWidth + kPixelWidth * (i + double(k) / kParts);
            const auto p = firstTriangle(scene, {x, y, 5}, {0, 0, -1});
            const double radiance = p ? smoothRadiance(*p) : 0;
            least = std::min(least, radiance), most = std::max(most, radiance);
            // On a convex body a ray from a facet is free if it leaves upwards, and blocked if not.
            if (p && glm::dot(p->geometric, kToLight) > 0) naive += radiance / (kParts + 1);
            facing = std::min(facing, p ? p->geometric.z : 0);
        }
        line.found.push_back(film.pixels[i].mean.x);
        line.least.push_back(least), line.most.push_back(most);
        line.naive.push_back(naive), line.facing.push_back(facing);
    }
    return line;
}

/// Largest change from pixel to pixel near the terminator, and largest against the direction of the
/// falloff (darker to the left).
struct Falloff {
    double step = 0, rise = 0;
};

/// Facets that face the viewer enough for a bound on the slope, and are dim.
constexpr double kLeastFacing = 0.6, kDim = 0.6 * kAlbedo / kPi;

Falloff falloffOf(const ScanLine& line, const std::vector<double>& radiance) {
    Falloff f;
    for (uint32_t i = 1; i < kPixels; ++i) {
        if (std::min(line.facing[i - 1], line.facing[i]) < kLeastFacing) continue;
        if (line.most[i] > kDim) continue;
        const double change = radiance[i] - radiance[i - 1];
        f.step = std::max(f.step, std::abs(change));
        f.rise = std::max(f.rise, -change);
    }
    return f;
}

class Terminator : public testing::TestWithParam<std::pair<uint32_t, uint32_t>> {
  protected:
    Scene sphere() const {
        SceneMaker b;
        addSmoothSphere(b, GetParam().first, GetParam().second, b.add(diffuse(float(kAlbedo))));
        Light sun;
        sun.kind = LightKind::Directional;
        sun.direction = glm::vec3(-kToLight);
        b.add(sun);
        return b.scene;
    }
};

TEST_P(Terminator, LightFallsOffAsOnTheSmoothSurface) {
    const Scene scene = sphere();
    // The normal turns by the distance walked over the distance from the centre (at least the
    // cosine of the largest tilt), and a walk on a facet is longer than its projection by its
    // cosine. Two pixels: samples may be at the far ends of both.
    const double bound =
        kAlbedo / kPi * 2 * kPixelWidth / (kLeastFacing * std::cos(largestTilt(scene)));
    // Eight parts a pixel miss its extremes by an eighth of its change; octahedral normals are
    // good to 4e-5.
    const double tolerance = bound / 8 + 1e-4;
    double naiveStep = 0, naiveOff = 0;
    for (const double y : {-0.31, 0.05, 0.58}) {
        const ScanLine line = scan(scene, y);
        for (uint32_t i = 0; i < kPixels; ++i) {
            if (line.facing[i] < kLeastFacing) continue;
            EXPECT_GE(line.found[i], line.least[i] - tolerance) << y << ' ' << i;
            EXPECT_LE(line.found[i], line.most[i] + tolerance) << y << ' ' << i;
            naiveOff = std::max(naiveOff, line.least[i] - line.naive[i]);
        }
        const Falloff found = falloffOf(line, line.found), naive = falloffOf(line, line.naive);
        EXPECT_LE(found.step, bound) << y;
        EXPECT_LE(found.rise, tolerance) << y << ": not monotone";
        naiveStep = std::max(naiveStep, naive.step);
    }
    EXPECT_GT(naiveStep, 3 * bound) << "negative control: light from flat facets has steps";
    EXPECT_GT(naiveOff, 10 * tolerance) << "negative control";
}

/// Without the offset light is that of flat facets, but for what eight parts of a pixel miss where
/// a facet begins; with the offset it is not.
TEST_P(Terminator, IsThatOfFlatFacetsWithoutOffset) {
    const Scene scene = sphere();
    double flat = 0, lifted = 0, all = 0;
    for (const double y : {-0.31, 0.05, 0.58}) {
        const ScanLine without = scan(scene, y, false), with = scan(scene, y);
        for (uint32_t i = 0; i < kPixels; ++i) {
            flat += std::abs(without.found[i] - without.naive[i]);
            lifted += std::abs(with.found[i] - without.naive[i]);
            all += without.naive[i];
        }
    }
    EXPECT_LT(flat / all, 1e-3);
    EXPECT_GT(lifted / all, 4e-3) << "negative control";
}

INSTANTIATE_TEST_SUITE_P(Spheres, Terminator,
                         testing::Values(std::pair(8u, 16u), std::pair(6u, 5u)),
                         test::NamedByValue{});

// --- Energy --------------------------------------------------------------------------------------

/// The white furnace: all of what a convex surface scatters escapes to the uniform light around it,
/// so that every sample is the albedo, no more and no less.
void expectNothingLost(const Material& material, DirectLight mode, double albedo) {
    SceneMaker b;
    addSmoothSphere(b, 8, 16, b.add(material));
    Light sky;
    sky.kind = LightKind::Ambient;
    b.add(sky);
    Camera camera;
    camera.orthographic = true;
    camera.position = {0, 0, 5};
    camera.halfWidth = camera.halfHeight = 0.65; // its corners are at 0.92: every sample hits
    RenderSettings s = smallPicture(64, 1);
    s.estimator.directLight = mode;
    s.area.width = s.area.height = 32;
    const Estimate found = estimate(b.scene, camera, s);
    EXPECT_NEAR(found.mean.x, albedo, 4.5 * found.error.x + 1e-6 * albedo);
    if (mode == DirectLight::Bsdf) {
        EXPECT_LT(found.error.x, 1e-6) << "samples differ";
    }
}

TEST(SmoothFurnace, NothingIsLostOutside) {
    for (const DirectLight mode : kDirectLightModes)
        expectNothingLost(diffuse(0.75f), mode, 0.75);
    Material mirror;
    mirror.kind = MaterialKind::Mirror;
    mirror.reflectance = glm::vec3(0.75f);
    expectNothingLost(mirror, DirectLight::Bsdf, 0.75);
}

/// The share of a cosine lobe that a plane tilted by an angle cuts off is (1 - cos angle) / 2: what
/// goes there is lost on the inner side, which is concave, and was lost on the outer one.
TEST(SmoothFurnace, LittleIsLostInside) {
    SceneMaker b;
    addSmoothSphere(b, 8, 16, b.add(diffuse(0.75f, 1)));
    const double share = (1 - std::cos(largestTilt(b.scene))) / 2;
    ASSERT_LT(share, 0.02);
    const Camera inside = pointCamera({0.1, 0.2, 0.3}, {0.7, -0.4, 0.1}, 1.0);
    RenderSettings s = smallPicture(64, 60);
    s.estimator.directLight = DirectLight::Bsdf;
    const Estimate found = estimate(b.scene, inside, s);
    EXPECT_GT(found.mean.x, 1 / (1 - 0.75 * (1 - share)) - 4.5 * found.error.x);
    EXPECT_LT(found.mean.x, 4 + 4.5 * found.error.x);
}

// --- Ways of finding light agree -----------------------------------------------------------------

/// Emitters near enough for the lift to matter: what is sampled is what bounces find.
TEST(SmoothSphere, EveryWayOfFindingEmittersGivesTheSame) {
    SceneMaker b;
    addSmoothSphere(b, 5, 8, b.add(diffuse(float(kAlbedo))));
    b.sphere({2.2f, 0, 0.5f}, 1, b.add(emissive(1)));
    b.quad({-1, 1.3f, -1}, {2, 0, 0}, {0, 0, 2}, b.add(emissive(1)));
    Camera camera;
    camera.orthographic = true;
    camera.position = {0, 0, 5};
    camera.halfWidth = camera.halfHeight = 0.6;
    RenderSettings s = smallPicture(256, 2);
    const Estimate lights = estimate(b.scene, camera, s);
    EXPECT_GT(lights.mean.x, 0.02);
    for (const DirectLight mode : {DirectLight::Hemisphere, DirectLight::Bsdf}) {
        s.estimator.directLight = mode;
        expectSameMean(estimate(b.scene, camera, s), lights);
    }
}

} // namespace
} // namespace stromboli

// Alpha of pictures with known answers.
#include "tests/analytic/seeing.hpp"
#include "tests/analytic/textured.hpp"

#include <cmath>
#include <functional>

namespace stromboli {
namespace {

using namespace test;

/// A floor of radiance 1 that ends at x = 0.03, on a card of opacity 0.25, in a bright environment.
Scene edgeAndCard() {
    SceneMaker b;
    b.quad({-9, -9, 0}, {9.03f, 0, 0}, {0, 18, 0}, b.add(emissive(1)));
    Material card = emissive(1);
    card.alphaMode = AlphaMode::Blend;
    card.opacity = 0.25f;
    b.quad({-1, 0, 1}, {9, 0, 0}, {0, 9, 0}, b.add(card));
    b.scene.environment = constantSky(5);
    return b.scene;
}

/// The colour of what is white is the alpha of each pixel: camera rays are the same ones, and what
/// they pass as well. For filters and lenses too.
TEST(Alpha, IsThatOfTheSamplesOfTheRadiance) {
    const Scene scene = edgeAndCard();
    Camera lens = straightDown(false);
    lens.lensRadius = 0.2;
    lens.focusDistance = 3;
    const std::pair<PixelFilter, Camera> views[] = {
        {PixelFilter::Box, straightDown()},
        {PixelFilter::Gaussian, straightDown(false)},
        {PixelFilter::BlackmanHarris, lens},
        {PixelFilter::Mitchell, straightDown(false)},
    };
    for (const auto& [filter, camera] : views) {
        const RenderSettings s = seenPicture(filter);
        const Film film = renderFilm(scene, camera, s);
        const auto seen = lookAt(scene, camera, Seeing::Coverage, 64, s);
        double partly = 0;
        for (size_t i = 0; i < seen.size(); ++i) {
            ASSERT_NEAR(seen[i].coverage(), film.pixels[i].mean.g, 1e-5) << i;
            partly += seen[i].coverage() > 0 && seen[i].coverage() < 1;
        }
        EXPECT_GT(partly, 40);
    }
}

/// The share of a half plane, of a card, of a disk: 64 samples in each of 192 pixels have a
/// standard error below 0.005.
TEST(Alpha, IsTheShareThatIsCovered) {
    // Half of the picture, and a quarter of a quarter of it.
    EXPECT_NEAR(meanCoverage(lookAt(edgeAndCard(), straightDown(), Seeing::Coverage, 64)),
                2.03 / 4 + 0.25 * 0.5 * 1.97 / 4, 0.02);
    SceneMaker ball;
    ball.sphere({0, 0, 0}, 1, ball.add(glass(1.5f))); // what is seen through it counts as covered
    EXPECT_NEAR(meanCoverage(lookAt(ball.scene, straightDown(), Seeing::Coverage, 64)), kPi / 12,
                0.02);
}

/// A picture of opacity counts for alpha and depth as it does for light: 12288 samples have a
/// standard error of 0.004.
TEST(Alpha, IsThatOfAPictureOfOpacity) {
    SceneMaker b;
    TextureMaker t(b.scene);
    Material m = diffuse(0.5f);
    m.alphaMode = AlphaMode::Blend;
    m.textures = {{.slot = TextureSlot::Opacity, .texture = t.constant(glm::vec4(0.25f, 1, 1, 1))}};
    b.quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, b.add(m));
    t.attributes(2, [](const glm::vec3&) { return VertexAttributes{}; });
    for (const Seeing what : {Seeing::Coverage, Seeing::Surfaces})
        EXPECT_NEAR(meanCoverage(lookAt(b.scene, straightDown(), what, 64)), 0.25, 0.02);
    RenderSettings depths = smallPicture(64, 0);
    depths.estimator.integrator = Integrator::Depth;
    expectMean(estimate(b.scene, straightDown(), depths), 0.25 * 4);
}

TEST(Alpha, IsNothingWhereNothingIs) {
    SceneMaker b;
    b.quad({-9, -9, 9}, {18, 0, 0}, {0, 18, 0}, b.add(diffuse(0.5f))); // behind the camera
    b.scene.environment = constantSky(5);
    EXPECT_EQ(meanCoverage(lookAt(b.scene, straightDown(), Seeing::Coverage)), 0);
    for (const PixelStatistics& p : renderFilm(b.scene, straightDown(), seenPicture()).pixels)
        EXPECT_EQ(p.mean, glm::dvec3(0));
}

/// It still lights: a grey floor in a white furnace is grey.
TEST(Alpha, TheHiddenEnvironmentLights) {
    SceneMaker b;
    addFloor(b, b.add(diffuse(0.5f)));
    b.scene.environment = constantSky(1);
    RenderSettings s = smallPicture(64, 1);
    s.estimator.showsBackdrop = false;
    expectMean(estimate(b.scene, pointCamera({1, 2, 3}, {0, 0, 0}), s), 0.5);
}

} // namespace
} // namespace stromboli

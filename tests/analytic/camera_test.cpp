// What the camera does to a picture whose content is known: the filter's blur of an edge, and the
// lens's blur of a point.
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stromboli {
namespace {

using namespace test;

/// Sees the plane z = 0 from z = distance; a pixel there is one unit wide and the middle of the
/// picture is the origin.
Camera facing(double distance, double pixels) {
    Camera camera = lookingAt({0, 0, distance}, {0, 0, 0}, pixels / 2 / distance);
    return camera;
}

/// Emits 1 where x < 0, on the plane z = 0.
Scene edge() {
    SceneMaker maker;
    maker.quad({-50, -50, 0}, {50, 0, 0}, {0, 100, 0}, maker.add(emissive(1)));
    return maker.scene;
}

/// Share of a filter's weight at distances below x from its middle line, in pixels.
double gaussianBelow(double x) {
    return 0.5 * std::erfc(-x / (0.5 * std::numbers::sqrt2));
}
double blackmanHarrisBelow(double x) {
    const double t = (x + 1.5) / 3, turn = 2 * std::numbers::pi;
    if (t <= 0 || t >= 1) return t <= 0 ? 0 : 1;
    return t - (0.48829 * std::sin(turn * t) - 0.14128 / 2 * std::sin(2 * turn * t) +
                0.01168 / 3 * std::sin(3 * turn * t)) /
                   (0.35875 * turn);
}

double tentBelow(double x) {
    const double rest = std::max(1 - std::abs(x), 0.0);
    return x < 0 ? rest * rest / 2 : 1 - rest * rest / 2;
}

/// Filters that are negative in places, by the pieces and products that define them.
double mitchellAt(double x, double b, double c) {
    x = std::abs(x);
    if (x >= 2) return 0;
    return x < 1
               ? ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + 6 - 2 * b) / 6
               : ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x - (12 * b + 48 * c) * x +
                  8 * b + 24 * c) /
                     6;
}
double lanczosAt(double x, double lobes) {
    const double turn = std::numbers::pi * std::abs(x);
    if (std::abs(x) >= lobes) return 0;
    return turn == 0 ? 1 : std::sin(turn) * std::sin(turn / lobes) * lobes / (turn * turn);
}

/// For a filter's weight, and for that of its absolute value, the shares below x, and the ratio of
/// both weights.
struct SignedShares {
    double below = 0, absoluteBelow = 0, ratio = 1;
};

template <class Filter>
SignedShares sharesBelow(double x, double radius, const Filter& filter) {
    constexpr int kSteps = 200000; // of 3e-5 pixels: errors of the midpoint rule are below 1e-8
    double all = 0, absolute = 0;
    SignedShares shares;
    for (int i = 0; i < kSteps; ++i) {
        const double at = radius * (2 * (i + 0.5) / kSteps - 1);
        const double value = filter(at);
        all += value, absolute += std::abs(value);
        if (at < x) shares.below += value, shares.absoluteBelow += std::abs(value);
    }
    shares.below /= all, shares.absoluteBelow /= absolute, shares.ratio = absolute / all;
    return shares;
}

SignedShares sharesOf(PixelFilter filter, const FilterShape& shape, double x) {
    const auto unsignedShare = [&](double below) { return SignedShares{below, below, 1}; };
    switch (filter) {
    case PixelFilter::Box:
        return unsignedShare(x > 0);
    case PixelFilter::Gaussian:
        return unsignedShare(gaussianBelow(x / shape.width));
    case PixelFilter::Tent:
        return unsignedShare(tentBelow(x / shape.width));
    case PixelFilter::BlackmanHarris:
        return unsignedShare(blackmanHarrisBelow(x));
    case PixelFilter::Mitchell:
        return sharesBelow(x, 2, [&](double at) { return mitchellAt(at, shape.b, shape.c); });
    case PixelFilter::CatmullRom:
        return sharesBelow(x, 2, [](double at) { return mitchellAt(at, 0, 0.5); });
    case PixelFilter::Lanczos:
        return sharesBelow(x, shape.lobes, [&](double at) { return lanczosAt(at, shape.lobes); });
    }
    return {};
}

/// Pixels on both sides of an edge that runs down the middle of the picture.
void expectBlurredEdge(PixelFilter filter, const FilterShape& shape) {
    SCOPED_TRACE(nameOf(filter));
    constexpr uint32_t kSamples = 20000;
    RenderSettings s = smallPicture(kSamples, 0);
    s.area = {8, 1, {}};
    s.estimator.filter = filter;
    s.estimator.filterShape = shape;
    s.estimator.sampler = Sampler::Independent;
    const Film film = renderFilm(edge(), facing(1000, 8), s);
    for (int pixel = 0; pixel < 8; ++pixel) {
        const double toEdge = 4 - (pixel + 0.5); // from the pixel's middle to x = 0
        const SignedShares shares = sharesOf(filter, shape, toEdge);
        // The variance of samples whose weights are the ratio across times that along, with signs.
        const double square = std::pow(shares.ratio, 4) * shares.absoluteBelow;
        const double error =
            std::sqrt(std::max(square - shares.below * shares.below, 1e-12) / kSamples);
        // 4.5 standard errors; what the Gaussian's cut takes away is 3.4e-4 of its weight, and the
        // kernel's table errs by less than 2e-4 (host/kernel/sampling_tables.hpp).
        EXPECT_NEAR(film.pixels[size_t(pixel)].mean.x, shares.below, 4.5 * error + 3.4e-4) << pixel;
    }
}

TEST(PixelFilters, BlurAnEdgeAsTheirIntegralSays) {
    for (const NamedValue<PixelFilter>& filter : kNamedValues<PixelFilter>)
        expectBlurredEdge(filter.value, {});
}

TEST(PixelFilters, HaveShapes) {
    expectBlurredEdge(PixelFilter::Gaussian, {.width = 1.7});
    expectBlurredEdge(PixelFilter::Tent, {.width = 2.5});
    expectBlurredEdge(PixelFilter::Mitchell, {.b = 0, .c = 1});
    expectBlurredEdge(PixelFilter::Mitchell, {.b = 1.5, .c = -0.25}); // negative in its middle
    expectBlurredEdge(PixelFilter::Lanczos, {.lobes = 2});
    expectBlurredEdge(PixelFilter::Lanczos, {.lobes = 1}); // nowhere negative
}

/// Weights are there for radiance that is left out as without them.
TEST(PixelFilters, NegativeSamplesAreNotRejected) {
    RenderSettings s = smallPicture(500, 0);
    s.area = {8, 1, {}};
    s.estimator.filter = PixelFilter::Lanczos;
    bool isNegative = false;
    for (const PixelStatistics& p : renderFilm(edge(), facing(1000, 8), s).pixels) {
        EXPECT_EQ(p.rejected, 0u);
        EXPECT_EQ(p.count, 500u);
        isNegative = isNegative || p.mean.x < 0;
    }
    EXPECT_TRUE(isNegative) << "beside the edge";
}

/// A middle beside the axis moves the picture as a whole: an edge by as much, and with a lens the
/// same points are sharp, in the same range of depths along the axis.
TEST(Shift, MovesThePictureAcrossTheAxis) {
    Camera camera = facing(10, 4);
    camera.shift.x = 1.75 * (camera.halfWidth / 2);
    RenderSettings s = smallPicture(40000, 0);
    s.area = {4, 1, {}};
    for (const double lensRadius : {0.0, 0.3}) {
        SCOPED_TRACE(lensRadius);
        camera.lensRadius = lensRadius;
        camera.focusDistance = 10;
        for (const double farDistance : {9.999, 10.001}) {
            camera.farDistance = farDistance;
            camera.nearDistance = farDistance - 0.5;
            const Film film = renderFilm(edge(), camera, s);
            for (size_t pixel = 0; pixel < 4; ++pixel) {
                const double expected = farDistance < 10 || pixel > 0 ? 0 : 0.25;
                EXPECT_NEAR(film.pixels[pixel].mean.x, expected, 4.5 * std::sqrt(0.19 / 40000))
                    << pixel;
            }
        }
    }
}

/// A point at another depth than the focus is blurred to a disk of radius
/// lens radius x |depth - focus| / focus on its own plane; an edge through it to the disk's
/// segment.
TEST(Lens, BlursWhatIsOutOfFocusToADisk) {
    for (const double focus : {6.0, 10.0, 20.0}) {
        SCOPED_TRACE(focus);
        RenderSettings s = smallPicture(40000, 0);
        s.area = {1, 1, {}};
        Camera camera = facing(10, 1e-6);
        camera.position.x = 0.3; // the edge is this far beside the middle
        camera.lensRadius = 2;
        camera.focusDistance = focus;
        const double radius = 2 * std::abs(10 - focus) / focus;
        double expected = 0;
        if (radius > 0.3) { // the segment of the unit disk beyond h
            const double h = 0.3 / radius;
            expected = (std::acos(h) - h * std::sqrt(1 - h * h)) / std::numbers::pi;
        }
        expectMean(estimate(edge(), camera, s), expected);
    }
}

TEST(Lens, LeavesWhatIsInFocusSharp) {
    Camera camera = facing(10, 4);
    RenderSettings s = smallPicture(64, 0);
    s.area = {4, 1, {}};
    camera.lensRadius = 1;
    camera.focusDistance = 10;
    const Film film = renderFilm(edge(), camera, s);
    for (size_t pixel = 0; pixel < 4; ++pixel)
        EXPECT_NEAR(film.pixels[pixel].mean.x, pixel < 2 ? 1 : 0, 1e-6) << pixel;
}

/// Near and far distances are depths along the axis for slanted rays, too.
TEST(Lens, KeepsTheDepthRange) {
    Camera camera = facing(10, 1e-6);
    camera.position.x = -5;
    camera.lensRadius = 3;
    camera.focusDistance = 4;
    const RenderSettings s = smallPicture(1000, 0);
    camera.farDistance = 9.999;
    expectMean(estimate(edge(), camera, s), 0);
    camera.farDistance = 10.001;
    camera.nearDistance = 9.999;
    expectMean(estimate(edge(), camera, s), 1);
}

} // namespace
} // namespace stromboli

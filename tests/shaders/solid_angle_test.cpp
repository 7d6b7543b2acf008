// spherical.glsl by way of light.comp: quads and triangles that are far, near, large, grazing and
// touched are sampled uniformly by solid angle. Chi-square tests have .01 for the file together.
#include "tests/shaders/light_fixture.hpp"
#include "tests/support/chi_square.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace stromboli::test {
namespace {

using gpu::LightAnswer;
using gpu::LightQuery;

constexpr size_t kAngleSamples = 60000;

/// An emitter v0 + s a + t b and a surface; with `triangle`, s + t <= 1.
struct EmitterCase {
    const char* name;
    glm::vec3 v0, a, b, position, normal;
    /// Mean square deviation over squared mean of the irradiance's samples, by area over by
    /// direction: at least.
    double areaIsWorse;
};

const EmitterCase kCases[] = {
    {"small", {0.3f, 0, 1}, {0.01f, 0, 0}, {0, 0.01f, 0}, {0, 0, 0}, {0, 0, 1}, 0.5},
    {"far", {3000, 200, 9000}, {1, 0.25f, 0}, {-0.5f, 0.75f, 0}, {0, 0, 0}, {0, 0, 1}, 0.1},
    {"large", {-4, -3, 0.5f}, {8, 0, 0}, {0, 7, 0}, {0, 0, 0}, {0, 0, 1}, 3},
    {"slanted", {-1, 1, 0.25f}, {2, 0.5f, 1.5f}, {-0.25f, 1, 0.5f}, {0, 0, 0}, {0, 0, 1}, 1},
    {"touched", {-0.5f, -0.25f, 0x1p-10f}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 1}, 1000},
    {"touchedAtTheEdge", {0, -0.5f, 0x1p-10f}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 1}, 1000},
    {"touchedAtTheCorner", {0, 0, 0x1p-10f}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 1}, 1000},
    {"grazing", {0.125f, -0.5f, 0x1p-8f}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 1}, 3},
    {"inACorner", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25f, 0.0625f, -1}, {0, 0, 1}, 1},
    {"onTheWall", {0, 0.25f, 0}, {1, 0, 0}, {0, 0, 1}, {0.5f, 0, 0.25f}, {0, 1, 0}, 1},
    {"sliver", {0, 0, 1}, {1, 0, 0}, {0.5f, 0.001f, 0}, {0.5f, 0, 0}, {0, 0, 1}, 0.5},
};

/// Van Oosterom and Strackee 1983, in double precision.
double solidAngle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    a = glm::normalize(a), b = glm::normalize(b), c = glm::normalize(c);
    const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
    return 2 * std::atan2(volume, 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(a, c));
}

/// Lambert's polygon: irradiance per radiance on a surface at the origin with unit normal n, all
/// corners above its horizon.
double irradiance(const std::vector<glm::dvec3>& corners, const glm::dvec3& n) {
    double sum = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 p = glm::normalize(corners[i]),
                         q = glm::normalize(corners[(i + 1) % corners.size()]);
        const glm::dvec3 c = glm::cross(p, q);
        const double sine = glm::length(c);
        if (sine > 0) sum += std::atan2(sine, glm::dot(p, q)) * glm::dot(c / sine, n);
    }
    return std::abs(sum) / 2;
}

class SolidAngles : public LightFixture,
                    public ::testing::WithParamInterface<std::tuple<EmitterCase, bool>> {
  protected:
    const EmitterCase& emitter() const { return std::get<0>(GetParam()); }
    bool isQuad() const { return std::get<1>(GetParam()); }
    glm::dvec3 at(double s, double t) const {
        return glm::dvec3(emitter().v0) - glm::dvec3(emitter().position) +
               s * glm::dvec3(emitter().a) + t * glm::dvec3(emitter().b);
    }
    std::vector<glm::dvec3> corners() const {
        if (isQuad()) return {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
        return {at(0, 0), at(1, 0), at(0, 1)};
    }
    double wholeAngle() const {
        double sum = 0;
        for (const double angle : cellAngles(1))
            sum += angle;
        return sum;
    }
    /// The cells of a grid in s and t; those of triangles are cut by the diagonal.
    std::vector<double> cellAngles(size_t grid) const {
        std::vector<double> angles(grid * grid);
        const double step = 1 / double(grid);
        for (size_t i = 0; i < grid; ++i)
            for (size_t j = 0; j < grid; ++j) {
                const double s = double(i) * step, t = double(j) * step;
                const size_t limit = isQuad() ? 2 * grid : grid;
                if (i + j < limit)
                    angles[i * grid + j] += solidAngle(at(s, t), at(s + step, t), at(s, t + step));
                if (i + j + 1 < limit)
                    angles[i * grid + j] +=
                        solidAngle(at(s + step, t + step), at(s + step, t), at(s, t + step));
            }
        return angles;
    }
    void makeScene() {
        Scene scene = sceneWithEmitter({1, 2, 4}, true);
        const glm::vec3 v0 = emitter().v0, a = v0 + emitter().a, b = v0 + emitter().b,
                        far = a + emitter().b;
        addEmitterTriangle(scene, v0, a, isQuad() ? far : b);
        if (isQuad()) addEmitterTriangle(scene, far, b, v0);
        setScene(scene);
        ASSERT_EQ(packed_.lights.sampledKinds,
                  1u << (isQuad() ? gpu::LIGHT_QUAD : gpu::LIGHT_TRIANGLE));
    }
    LightQuery surface() const {
        LightQuery q = surfaceAt(emitter().position, emitter().normal);
        q.error = glm::vec3(0.0f); // the point is where it is
        return q;
    }
};

TEST_P(SolidAngles, AreSampledUniformly) {
    makeScene();
    const std::vector<LightAnswer> found = answers(samples(surface(), kAngleSamples, 141));
    const double angle = wholeAngle();
    const glm::dmat3 toWeights = glm::inverse(
        glm::dmat3(glm::dvec3(emitter().a), glm::dvec3(emitter().b),
                   glm::normalize(glm::cross(glm::dvec3(emitter().a), glm::dvec3(emitter().b)))));
    constexpr size_t kGrid = 8;
    std::vector<double> counts(kGrid * kGrid), expected = cellAngles(kGrid);
    for (double& e : expected)
        e *= double(kAngleSamples) / angle;
    // A few roundings of coordinates, over edges of 1 or in an emitter that is small and near.
    const double off = 1e-4 + 0x1p-22 * glm::length(emitter().v0);
    double sum = 0, squares = 0;
    for (const LightAnswer& a : found) {
        ASSERT_TRUE(isSound(a));
        // Rounding of the sum 1 + three cosines, 2^-22, over its size in the touched cases, 2^-7.
        ASSERT_NEAR(a.radiance.y / (2 * angle), 1, 3e-5) << "not the inverse of the density";
        ASSERT_EQ(a.blocked, 0u) << "the emitter shades itself";
        const glm::dvec3 w = toWeights * (glm::dvec3(a.target) - glm::dvec3(emitter().v0));
        ASSERT_GT(std::min(w.x, w.y), -off);
        ASSERT_LT(isQuad() ? std::max(w.x, w.y) : w.x + w.y, 1 + off);
        const auto cell = [](double x) {
            return std::min(size_t(std::max(x, 0.0) * kGrid), kGrid - 1);
        };
        ++counts[cell(w.x) * kGrid + cell(w.y)];
        const double value = a.radiance.x * double(glm::dot(a.direction, emitter().normal));
        sum += value;
        squares += value * value;
    }
    if (!isQuad()) // rounding may put a point of the diagonal into the cells beyond it
        for (size_t i = 1; i < kGrid; ++i)
            counts[i * kGrid + kGrid - 1 - i] += std::exchange(counts[i * kGrid + kGrid - i], 0);
    EXPECT_GT(chiSquareTest(counts, expected), sidakLevel(0.01, 2 * std::size(kCases)));
    const double mean = sum / kAngleSamples, truth = irradiance(corners(), emitter().normal);
    const double variance = squares / kAngleSamples - mean * mean;
    EXPECT_NEAR(mean, truth,
                4.5 * std::sqrt(std::max(variance, 0.0) / kAngleSamples) + 1e-5 * truth);

    // Negative control: the same emitter by area.
    Random random(142);
    double areaSum = 0, areaSquares = 0;
    const glm::dvec3 normal = glm::cross(glm::dvec3(emitter().a), glm::dvec3(emitter().b));
    for (size_t i = 0; i < kAngleSamples; ++i) {
        double s = random.uniform(), t = random.uniform();
        if (!isQuad() && s + t > 1) s = 1 - s, t = 1 - t;
        const glm::dvec3 to = at(s, t);
        const double d2 = glm::dot(to, to);
        const double value = std::abs(glm::dot(to, normal)) *
                             glm::dot(to, glm::dvec3(emitter().normal)) / (d2 * d2) *
                             (isQuad() ? 1 : 0.5);
        areaSum += value;
        areaSquares += value * value;
    }
    const double relative = variance / (mean * mean);
    const double relativeByArea = areaSquares * kAngleSamples / (areaSum * areaSum) - 1;
    EXPECT_GT(relativeByArea, emitter().areaIsWorse * relative);
}

TEST_P(SolidAngles, EndsOfTheSquareAreSound) {
    makeScene();
    for (const LightAnswer& a : answers(ends(surface())))
        EXPECT_TRUE(isSound(a));
}

INSTANTIATE_TEST_SUITE_P(Emitters, SolidAngles,
                         ::testing::Combine(::testing::ValuesIn(kCases), ::testing::Bool()),
                         [](const auto& test) {
                             return std::string(std::get<0>(test.param).name) +
                                    (std::get<1>(test.param) ? "Quad" : "Triangle");
                         });

class InThePlane : public LightFixture {};

/// In the plane of an emitter, or as near to it as rounding puts a surface that lies in it, there
/// is no light, and nothing that is not a number.
TEST_F(InThePlane, OfAnEmitterThereIsNoLight) {
    Scene scene = sceneWithEmitter({1, 1, 1}, true);
    addEmitterTriangle(scene, {0, 0, 1}, {1, 0, 1}, {1, 1, 1});
    addEmitterTriangle(scene, {1, 1, 1}, {0, 1, 1}, {0, 0, 1});
    setScene(scene);
    for (const glm::vec3 p : {glm::vec3(0.5f, 0.25f, 1), glm::vec3(0, 0, 1), glm::vec3(1, 0.5f, 1),
                              glm::vec3(2, 0, 1), glm::vec3(0.5f, 0.5f, 1 - 0x1p-24f)})
        for (const LightAnswer& a : answers(samples(surfaceAt(p, {0, 0, -1}), 200, 143))) {
            const glm::vec3 all = a.target + a.direction + a.radiance;
            ASSERT_TRUE(std::isfinite(all.x + all.y + all.z));
            ASSERT_EQ(a.radiance, glm::vec3(0.0f));
        }
}

} // namespace
} // namespace stromboli::test

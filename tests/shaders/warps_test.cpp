// The warps of [0,1)^2, frames and octahedral normals: distributions by chi-square at a level of
// .01 for all tests of this file together, and the ends of the square.
#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/chi_square.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/warps_shader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace stromboli::test {
namespace {

using gpu::WarpAnswer;
using gpu::WarpQuery;

constexpr size_t kWarpGrid = 16, kWarpSamples = 200000;
const double kLevel = sidakLevel(0.01, 9);

class Warps : public DeviceTest {
  protected:
    std::vector<WarpAnswer> answers(const std::vector<WarpQuery>& queries) {
        return ask<WarpAnswer>(warps_shader, queries);
    }

    std::vector<WarpAnswer> randomAnswers(uint32_t seed, float alpha = 0.1f) {
        Random random(seed);
        std::vector<WarpQuery> queries(kWarpSamples);
        for (WarpQuery& q : queries) {
            q.normal = {0, 0, 1};
            q.alpha = alpha;
            q.u = random.uniform();
            q.v = random.uniform();
        }
        return answers(queries);
    }
};

/// Chi-square of a map of each answer to the unit square, uniform there if the warp is right.
double uniformOnSquare(const std::vector<WarpAnswer>& found,
                       const std::function<glm::dvec2(const WarpAnswer&)>& toSquare) {
    std::vector<double> counts(kWarpGrid * kWarpGrid);
    for (const WarpAnswer& a : found) {
        const glm::dvec2 p = toSquare(a) * double(kWarpGrid);
        const auto cell = [](double x) {
            return std::min(size_t(std::max(x, 0.0)), kWarpGrid - 1);
        };
        ++counts[cell(p.x) * kWarpGrid + cell(p.y)];
    }
    const double each = double(found.size()) / double(kWarpGrid * kWarpGrid);
    return chiSquareTest(counts, std::vector<double>(counts.size(), each));
}

double azimuth(double x, double y) {
    const double turns = std::atan2(y, x) / (2 * kPi);
    return turns < 0 ? turns + 1 : turns;
}

/// All around, ends and eighths of a turn included. Of both 1 ulp is 2^-24 below 1.
TEST_F(Warps, CosineAndSineOfATurn) {
    std::vector<WarpQuery> queries(100001);
    for (size_t i = 0; i < queries.size(); ++i)
        queries[i].u = float(i) / float(queries.size() - 1);
    const std::vector<WarpAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const double angle = 2 * kPi * double(queries[i].u);
        ASSERT_NEAR(found[i].cosine4u, std::cos(angle), 0x1p-23) << queries[i].u;
        ASSERT_NEAR(found[i].sine4u, std::sin(angle), 0x1p-23) << queries[i].u;
    }
}

TEST_F(Warps, DiskIsUniform) {
    EXPECT_GT(uniformOnSquare(randomAnswers(81),
                              [](const WarpAnswer& a) {
                                  const double x = a.diskX, y = a.diskY;
                                  return glm::dvec2(x * x + y * y, azimuth(x, y));
                              }),
              kLevel);
}

/// Under a cosine density, cos^2 is uniform.
TEST_F(Warps, CosineHemisphere) {
    EXPECT_GT(uniformOnSquare(randomAnswers(82),
                              [](const WarpAnswer& a) {
                                  const glm::dvec3 w(a.cosine);
                                  return glm::dvec2(w.z * w.z, azimuth(w.x, w.y));
                              }),
              kLevel);
}

TEST_F(Warps, UniformHemisphere) {
    EXPECT_GT(uniformOnSquare(randomAnswers(83),
                              [](const WarpAnswer& a) {
                                  const glm::dvec3 w(a.hemisphere);
                                  return glm::dvec2(w.z, azimuth(w.x, w.y));
                              }),
              kLevel);
}

/// Seen along the normal, D cos over the solid angle integrates to 1 - exp(-tan^2 / alpha^2) from
/// the pole.
TEST_F(Warps, BeckmannHalfVectors) {
    for (const float alpha : {0.01f, 0.1f, 0.5f, 1.0f})
        EXPECT_GT(uniformOnSquare(randomAnswers(84, alpha),
                                  [alpha](const WarpAnswer& a) {
                                      const glm::dvec3 h(a.beckmann);
                                      const double tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
                                      return glm::dvec2(-std::expm1(-tan2 / (alpha * alpha)),
                                                        azimuth(h.x, h.y));
                                  }),
                  kLevel)
            << alpha;
}

TEST_F(Warps, EndsOfTheSquare) {
    std::vector<WarpQuery> queries;
    const float ends[] = {0, 0x1p-24f, 0x1p-12f, 0.25f, 0.5f, 0.75f, 1 - 0x1p-23f, 1 - 0x1p-24f};
    for (const float u : ends)
        for (const float v : ends)
            for (const float alpha : {1e-4f, 0.1f, 1.0f})
                queries.push_back({{0, 0, 1}, alpha, u, v, 0, 0});
    const std::vector<WarpAnswer> found = answers(queries);
    for (size_t i = 0; i < found.size(); ++i) {
        const WarpAnswer& a = found[i];
        const std::string at = std::to_string(queries[i].u) + " " + std::to_string(queries[i].v);
        EXPECT_LE(std::hypot(a.diskX, a.diskY), 1 + 4 * 0x1p-24) << at;
        for (const glm::vec3& w : {a.cosine, a.hemisphere, a.beckmann}) {
            EXPECT_NEAR(glm::length(glm::dvec3(w)), 1, 1e-6) << at; // fails for NaN
            EXPECT_GE(w.z, 0) << at;
        }
        EXPECT_GT(a.cosine.z, 0) << at << ": a weight of f cos / pdf = 0 / 0";
        EXPECT_GT(a.beckmann.z, 0) << at;
    }
}

TEST_F(Warps, FramesAreOrthonormal) {
    std::vector<WarpQuery> queries;
    const auto add = [&](const glm::vec3& n) { queries.push_back({n, 0.1f, 0, 0, 0, 0}); };
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
            for (const float zero : {0.0f, -0.0f}) {
                glm::vec3 n(zero);
                n[axis] = sign;
                add(n);
            }
    // The vectors of Duff et al. 2017, table 1: where older constructions lose all digits.
    add({0.00038527316f, 0.00038460016f, -0.99999988079f});
    add({-0.00019813581f, -0.00008946839f, -0.99999988079f});
    Random random(86);
    for (int i = 0; i < 20000; ++i) {
        const float nearPole = i % 2 ? 1 : std::exp2(-float(i % 50));
        glm::dvec3 n = random.vector();
        n.x *= nearPole, n.y *= nearPole;
        add(glm::vec3(glm::normalize(n)));
    }
    const std::vector<WarpAnswer> found = answers(queries);
    for (size_t i = 0; i < found.size(); ++i) {
        const glm::dvec3 x(found[i].frameX), y(found[i].frameY), z(found[i].frameZ);
        ASSERT_EQ(found[i].frameZ, queries[i].normal);
        for (const double product :
             {glm::dot(x, x) - 1, glm::dot(y, y) - 1, glm::dot(x, y), glm::dot(x, z),
              glm::dot(y, z), glm::dot(glm::cross(x, y), z) - 1})
            ASSERT_NEAR(product, 0, 6e-7) << i;
    }
}

TEST_F(Warps, OctahedralNormals) {
    std::vector<glm::vec3> normals;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            glm::vec3 n(0.0f);
            n[axis] = sign;
            normals.push_back(n);
        }
    Random random(87);
    for (int i = 0; i < 100000; ++i) {
        glm::dvec3 n = random.vector();
        if (i % 3 == 0) n[i / 3 % 3] *= 1e-4; // near the folds
        normals.push_back(glm::vec3(glm::normalize(n)));
    }
    std::vector<WarpQuery> queries;
    for (const glm::vec3& n : normals)
        queries.push_back({{0, 0, 1}, 0.1f, 0, 0, encodeNormal(n), 0});
    const std::vector<WarpAnswer> found = answers(queries);
    for (size_t i = 0; i < normals.size(); ++i) {
        const glm::dvec3 decoded(found[i].decoded);
        EXPECT_NEAR(glm::length(decoded), 1, 1e-6) << i;
        const double angle = glm::length(glm::cross(glm::dvec3(normals[i]), decoded));
        ASSERT_LT(angle, 1e-4) << i;
        ASSERT_GT(glm::dot(glm::dvec3(normals[i]), decoded), 0) << i;
        EXPECT_TRUE(i >= 6 || found[i].decoded == normals[i]) << "axis " << i << " is not exact";
    }
}

} // namespace
} // namespace stromboli::test

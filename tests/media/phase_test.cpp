// Phase functions and sums of them, in the shaders and in the reference: against each other, and
// against closed forms and integrals.
#include "host/bvh/wide_layout.hpp"
#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/reference/medium.hpp"
#include "shaders/shared/bsdf_types.h"
#include "shaders/shared/medium_types.h"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/bsdf_texel.h"

#include <algorithm>
#include <cmath>

namespace stromboli::test {
namespace {

constexpr PhaseFunction kHg = PhaseFunction::HenyeyGreenstein;

Medium mediumOfPhases(std::vector<PhaseLobe> lobes) {
    Medium m;
    m.scattering = glm::vec3(1);
    EXPECT_TRUE(m.setPhases(std::move(lobes)));
    return m;
}

std::vector<Medium> mediaOfPhases() {
    return {mediumOfPhases({{kHg, 0, 1}}),
            mediumOfPhases({{kHg, -0.6f, 1}}),
            mediumOfPhases({{PhaseFunction::Rayleigh, 0, 1}}),
            mediumOfPhases({{kHg, 0.8f, 0.75f}, {kHg, -0.3f, 0.25f}}),
            mediumOfPhases({{kHg, 0.95f, 0.5f}, {kHg, 0, 0.5f}}),
            mediumOfPhases({{PhaseFunction::Rayleigh, 0, 0.6f}, {kHg, 0.5f, 0.4f}}),
            mediumOfPhases({{kHg, 0.9f, 2}, {PhaseFunction::Rayleigh, 0, 1}, {kHg, -0.5f, 1}})};
}

/// The mean cosine of a sum is that of its parts; Rayleigh's is 0.
double meanCosine(const Medium& m) {
    double sum = 0;
    for (const PhaseLobe& lobe : m.phases())
        if (lobe.phase == kHg) sum += double(lobe.share) * double(lobe.asymmetry);
    return sum;
}

/// The share of light that turns to a cosine of at most `most`, by the density.
double shareBelow(const Medium& m, double most) {
    constexpr int kSteps = 20'000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        sum += reference::phaseDensity(m, -1 + (most + 1) * (i + 0.5) / kSteps);
    return 2 * 3.14159265358979323846 * sum * (most + 1) / kSteps;
}

constexpr uint32_t kSamples = 1 << 14;
constexpr double kThresholds[] = {-0.9, -0.5, 0, 0.4, 0.8, 0.99, 1};

/// Cosines of samples from numbers in equal steps: as many of them as the density says are below
/// any threshold, but for those of a step in each part of the sum.
void expectDistribution(const Medium& m, const std::vector<double>& cosines, size_t number) {
    const double step = double(kMostPhases + 1) / kSamples;
    double mean = 0;
    for (const double cosine : cosines)
        mean += cosine / kSamples;
    EXPECT_NEAR(mean, meanCosine(m), 2 * step) << number;
    for (const double most : kThresholds) {
        const auto below = std::ranges::count_if(cosines, [&](double c) { return c <= most; });
        const double expected = shareBelow(m, most);
        EXPECT_NEAR(double(below) / kSamples, expected, step + 1e-4) << number << ' ' << most;
    }
    EXPECT_NEAR(shareBelow(m, 1), 1, 1e-4) << number;
}

TEST(PhaseFunctions, OfTheReferenceAreSampledByTheirDensity) {
    Random random(1);
    const std::vector<Medium> media = mediaOfPhases();
    for (size_t n = 0; n < media.size(); ++n) {
        const glm::dvec3 forward(random.direction());
        std::vector<double> cosines;
        for (uint32_t i = 0; i < kSamples; ++i) {
            const glm::dvec3 wi = reference::samplePhase(media[n], forward, (i + 0.5) / kSamples,
                                                         double(random.uniform()));
            EXPECT_NEAR(glm::length(wi), 1, 1e-6);
            cosines.push_back(std::min(glm::dot(wi, glm::normalize(forward)), 1.0));
        }
        expectDistribution(media[n], cosines, n);
    }
}

class PhaseShader : public DeviceTest {
  protected:
    PhaseShader()
        : shader_(bsdf_texel,
                  ShaderOptions::texel()
                      .set(SPEC_CLOSURES, gpu::PHASE_FUNCTION | gpu::PHASE_IS_RAYLEIGH |
                                              gpu::LOBE_DIFFUSE_REFLECTION)
                      .set(SPEC_MEDIA, gpu::MEDIA_DIM | gpu::MEDIA_SCATTER | gpu::MEDIA_MIX)) {
        Scene scene;
        scene.materials.emplace_back();
        scene.media = media_;
        shader_.setScene(packScene(scene, buildWideBvh(scene)));
        firstRow_ = packMaterials(scene.materials, {}, scene.media).media.firstRow;
    }

    gpu::BsdfQuery query(size_t medium, Random& random) const {
        gpu::BsdfQuery q{};
        q.materialRow = firstRow_[medium];
        q.wo = random.direction();
        q.wi = random.direction();
        q.u = random.uniform(), q.v = random.uniform();
        return q;
    }

    std::vector<Medium> media_ = mediaOfPhases();
    std::vector<uint32_t> firstRow_;
    TestShader shader_;
};

/// Directions are rounded by some 1e-7, which is 4e-5 of the square of the width of the narrowest.
TEST_F(PhaseShader, HasTheDensitiesOfTheReference) {
    Random random(2);
    std::vector<gpu::BsdfQuery> queries;
    for (uint32_t i = 0; i < 4000; ++i) {
        queries.push_back(query(i % media_.size(), random));
        if (i % 3 == 0) // near the peak
            queries.back().wi = glm::normalize(0.05f * random.direction() - queries.back().wo);
    }
    const auto answers = ask<gpu::BsdfAnswer>(shader_, queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const Medium& m = media_[i % media_.size()];
        const glm::dvec3 wo = glm::normalize(glm::dvec3(queries[i].wo));
        const auto density = [&](const glm::vec3& wi) {
            return reference::phaseDensity(m, -glm::dot(wo, glm::normalize(glm::dvec3(wi))));
        };
        EXPECT_NEAR(double(answers[i].pdf) / density(queries[i].wi), 1, 5e-4) << i;
        EXPECT_EQ(answers[i].value, glm::vec3(answers[i].pdf)) << i;
        EXPECT_NEAR(double(answers[i].samplePdf) / density(answers[i].direction), 1, 2e-3) << i;
        EXPECT_EQ(answers[i].weight, glm::vec3(1)) << i;
    }
}

TEST_F(PhaseShader, IsSampledByItsDensity) {
    Random random(3);
    for (size_t n = 0; n < media_.size(); ++n) {
        std::vector<gpu::BsdfQuery> queries;
        for (uint32_t i = 0; i < kSamples; ++i) {
            queries.push_back(query(n, random));
            queries.back().u = float((i + 0.5) / kSamples);
        }
        const auto answers = ask<gpu::BsdfAnswer>(shader_, queries);
        std::vector<double> cosines;
        for (size_t i = 0; i < queries.size(); ++i)
            cosines.push_back(std::min(
                -glm::dot(glm::dvec3(queries[i].wo), glm::dvec3(answers[i].direction)), 1.0));
        expectDistribution(media_[n], cosines, n);
    }
}

} // namespace
} // namespace stromboli::test

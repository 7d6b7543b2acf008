// Hard cases 37 to 40: samplers. Here the double-precision code of the reference; the kernel's
// samplers have the same tests in tests/shaders.
#include "host/reference/microfacet.hpp"
#include "host/reference/sampling.hpp"
#include "tests/hard_cases/inverses.hpp"
#include "tests/hard_cases/uniform.hpp"
#include "tests/support/chi_square.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace stromboli::test {
namespace {

using namespace reference;

constexpr size_t kGrid = 16, kSamples = 200000;

using Map = std::function<glm::dvec2(double, double)>; ///< two random numbers to the unit square

/// The probability of counts as uneven as these if `map` leaves the square's measure as it is.
double chiSquareOf(const Map& map, uint64_t seed) {
    Uniform uniform(seed);
    std::vector<double> counts(kGrid * kGrid);
    const auto cell = [](double x) {
        return std::min(size_t(std::max(x, 0.0) * kGrid), kGrid - 1);
    };
    for (size_t i = 0; i < kSamples; ++i) {
        const double u = uniform(), v = uniform();
        const glm::dvec2 p = map(u, v);
        ++counts[cell(p.x) * kGrid + cell(p.y)];
    }
    return chiSquareTest(
        counts, std::vector<double>(counts.size(), double(kSamples) / double(kGrid * kGrid)));
}

glm::dvec3 atAngle(double theta, double v) {
    return {std::sin(theta) * std::cos(2 * kPi * v), std::sin(theta) * std::sin(2 * kPi * v),
            std::cos(theta)};
}

/// A warp followed by its distribution function is the identity in distribution. Chi-square at .01
/// for all together; angles drawn uniformly fail.
TEST(HardCases, C37_SamplersFollowTheirDensities) {
    constexpr double kAlpha = 0.2, kCone = 0.1; // 1 - cos
    const auto cosine = [](const glm::dvec3& w) { return invertCosineHemisphere(w); };
    const auto hemisphere = [](const glm::dvec3& w) { return invertUniformCone(w, 1); };
    const auto sphere = [](const glm::dvec3& w) { return invertUniformCone(w, 2); };
    const auto cone = [](const glm::dvec3& w) { return invertUniformCone(w, kCone); };
    const auto beckmann = [](const glm::dvec3& h) { return invertBeckmann(h, kAlpha); };
    const auto triangle = [](const glm::dvec2& b) { return squareOfTriangle(b); };
    struct SamplerCase {
        const char* name;
        Map right, naive;
    };
    const std::vector<SamplerCase> samplers = {
        {"cosine", [&](double u, double v) { return cosine(cosineHemisphere(u, v)); },
         [&](double u, double v) { return cosine(atAngle(u * kPi / 2, v)); }},
        {"hemisphere", [&](double u, double v) { return hemisphere(uniformHemisphere(u, v)); },
         [&](double u, double v) { return hemisphere(atAngle(u * kPi / 2, v)); }},
        {"sphere", [&](double u, double v) { return sphere(uniformSphere(u, v)); },
         [&](double u, double v) { return sphere(atAngle(u * kPi, v)); }},
        {"cone", [&](double u, double v) { return cone(uniformCone(u, v, kCone)); },
         [&](double u, double v) { return cone(atAngle(u * std::acos(1 - kCone), v)); }},
        {"beckmann", [&](double u, double v) { return beckmann(sampleBeckmann(kAlpha, u, v)); },
         [&](double u, double v) { return beckmann(atAngle(std::atan(kAlpha * u * 2), v)); }},
        {"triangle", [&](double u, double v) { return triangle(uniformTriangle(u, v)); },
         [&](double u, double v) {
             return triangle({u * (1 - v), v});
         }},
    };
    for (const SamplerCase& s : samplers) {
        EXPECT_GT(chiSquareOf(s.right, 37), sidakLevel(0.01, samplers.size())) << s.name;
        EXPECT_LT(chiSquareOf(s.naive, 37), 1e-6) << "negative control: " << s.name;
    }
}

/// At the ends of [0, 1 - 2^-24] all samplers give unit vectors in their domain. A float that is
/// rounded to 1 does not.
TEST(HardCases, C38_EndsOfTheUnitInterval) {
    const double ends[] = {0, 0x1p-53, 0x1p-24, 0.5, 1 - 0x1p-24, 1 - 0x1p-53};
    for (const double u : ends)
        for (const double v : ends)
            for (const double alpha : {1e-4, 0.1, 1.0}) {
                for (const glm::dvec3& w : {cosineHemisphere(u, v), uniformHemisphere(u, v),
                                            uniformCone(u, v, 1e-9), sampleBeckmann(alpha, u, v)}) {
                    EXPECT_NEAR(glm::length(w), 1, 1e-12) << u << ' ' << v;
                    EXPECT_GE(w.z, 0) << u << ' ' << v;
                }
                EXPECT_GT(sampleBeckmann(alpha, u, v).z, 0) << "a density of 0";
                const glm::dvec2 b = uniformTriangle(u, v);
                EXPECT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1 + 0x1p-52);
            }
    const float one = float(0xFFFFFFFFu) * 0x1p-32f; // of the largest word
    const double z = std::sqrt(1 - double(one));
    EXPECT_TRUE(std::isnan(z * kPi / (z * kPi))) << "negative control: f cos / pdf = 0 / 0";
}

/// Back to where a direction came from, within 1e-3, at the ends of the interval too; v where the
/// direction has an angle about z at all, and modulo a turn.
TEST(HardCases, C38_InversesGoBack) {
    struct RoundTrip {
        const char* name;
        Map there;
    };
    constexpr double kAlpha = 0.2, kCone = 1e-9;
    const std::vector<RoundTrip> trips = {
        {"cosine",
         [](double u, double v) { return invertCosineHemisphere(cosineHemisphere(u, v)); }},
        {"hemisphere",
         [](double u, double v) { return invertUniformCone(uniformHemisphere(u, v), 1); }},
        {"sphere", [](double u, double v) { return invertUniformCone(uniformSphere(u, v), 2); }},
        {"cone",
         [](double u, double v) { return invertUniformCone(uniformCone(u, v, kCone), kCone); }},
        {"beckmann",
         [](double u, double v) { return invertBeckmann(sampleBeckmann(kAlpha, u, v), kAlpha); }}};
    Uniform uniform(38);
    double naiveWorst = 0;
    for (const RoundTrip& trip : trips)
        for (int i = 0; i < 1000; ++i) {
            const double u = i == 0 ? 0 : i == 1 ? 1 - 0x1p-24 : uniform();
            const double v = i == 2 ? 0 : i == 3 ? 1 - 0x1p-24 : uniform();
            const glm::dvec2 back = trip.there(u, v);
            EXPECT_NEAR(back.x, u, 1e-3) << trip.name << ' ' << u << ' ' << v;
            if (u > 0) {
                EXPECT_NEAR(std::remainder(back.y - v, 1), 0, 1e-3)
                    << trip.name << ' ' << u << ' ' << v;
            }
            // The cone's angle by 1 - cos in float.
            const glm::dvec3 w = uniformCone(u, v, kCone);
            naiveWorst = std::max(naiveWorst, std::abs((1 - float(w.z)) / kCone - u));
        }
    EXPECT_GT(naiveWorst, 0.5) << "negative control: 1 - cos of a narrow cone";
}

/// The integral of the density of microfacet directions is the share of samples that end up above
/// the surface; where it is zero no sample falls.
TEST(HardCases, C39_DensitiesIntegrateToWhatIsSampled) {
    Uniform uniform(39);
    for (const double alpha : {0.3, 0.7})
        for (const double cosine : {0.9, 0.4}) {
            const glm::dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
            double integral = 0, naive = 0;
            constexpr int kSteps = 400;
            for (int i = 0; i < kSteps; ++i)
                for (int k = 0; k < kSteps; ++k) {
                    const glm::dvec3 wi = uniformHemisphere((i + 0.5) / kSteps, (k + 0.5) / kSteps);
                    const double density = microfacetDensity(alpha, wo, wi);
                    integral += 2 * kPi * density / (kSteps * kSteps);
                    // Without the Jacobian of the reflection.
                    const glm::dvec3 h = glm::normalize(wo + wi);
                    naive += 2 * kPi * beckmannD(h, alpha) * h.z / (kSteps * kSteps);
                }
            int above = 0;
            for (int i = 0; i < 200000; ++i) {
                const glm::dvec3 h = sampleBeckmann(alpha, uniform(), uniform());
                const glm::dvec3 wi = 2 * glm::dot(wo, h) * h - wo;
                above += wi.z > 0 && glm::dot(wo, h) > 0;
                EXPECT_TRUE(!(wi.z > 0) || microfacetDensity(alpha, wo, wi) > 0);
            }
            EXPECT_NEAR(integral, above / 200000.0, 0.005) << alpha << ' ' << cosine;
            EXPECT_GT(std::abs(naive - above / 200000.0), 0.05) << "negative control";
        }
}

/// Under radiance 1 all around, a conductor that absorbs nothing sends back 1 at most, at every
/// angle and roughness; f is the same both ways.
TEST(HardCases, C40_NoMoreIsReflectedThanArrives) {
    Material m;
    m.kind = MaterialKind::Conductor;
    m.eta = glm::vec3(1), m.k = glm::vec3(1e6f);
    Uniform uniform(40);
    double naiveMost = 0;
    for (const float alpha : {1.0f, 0.3f, 0.05f})
        for (const double cosine : {1.0, 0.5, 0.1, 0.01}) {
            m.facets = {FacetDistribution::Beckmann, glm::vec2(alpha)};
            const glm::dvec3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
            double sum = 0, naive = 0, squares = 0;
            constexpr int kCount = 40000;
            for (int i = 0; i < kCount; ++i) {
                const glm::dvec3 h = sampleBeckmann(alpha, uniform(), uniform());
                const glm::dvec3 wi = 2 * glm::dot(wo, h) * h - wo;
                if (!(wi.z > 0 && glm::dot(wo, h) > 0)) continue;
                const double density = microfacetDensity(alpha, wo, wi);
                const double weight = microfacet(m, wo, wi, {}).x * wi.z / density;
                sum += weight, squares += weight * weight;
                naive += beckmannD(h, alpha) / (4 * wo.z * wi.z) * wi.z / density; // no shadowing
                const double there = microfacet(m, wo, wi, {}).x;
                const double back = microfacet(m, wi, wo, {}).x;
                EXPECT_NEAR(there / back, 1, 1e-9);
            }
            const double mean = sum / kCount, variance = squares / kCount - mean * mean;
            EXPECT_LE(mean, 1 + 3 * std::sqrt(variance / kCount) + 1e-9) << alpha << ' ' << cosine;
            naiveMost = std::max(naiveMost, naive / kCount);
        }
    EXPECT_GT(naiveMost, 2) << "negative control: without shadowing and masking";
}

} // namespace
} // namespace stromboli::test

// Mixtures whose materials are evaluated together: values and densities are the sums of the
// reference's over the materials, by their shares, whichever of them is drawn; weights are value
// over density; samples fall where the density of all says.
#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/reference/bsdf.hpp"
#include "scene/generate/scene_maker.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/chi_square.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/mixture_texel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace stromboli::test {
namespace {

using std::numbers::pi;

Material conductorOf(float alpha) {
    Material m;
    m.kind = MaterialKind::Conductor;
    m.facets = {FacetDistribution::Ggx, glm::vec2(alpha)};
    m.eta = {0.2f, 0.9f, 1.1f};
    m.k = {3.9f, 2.4f, 2.2f};
    return m;
}

Material roughGlass() {
    Material m;
    m.kind = MaterialKind::Dielectric;
    m.facets = {FacetDistribution::Beckmann, glm::vec2(0.4f)};
    return m;
}

Material mirrorOf(float reflectance) {
    Material m;
    m.kind = MaterialKind::Mirror;
    m.reflectance = glm::vec3(reflectance);
    return m;
}

Material coated() {
    Material m;
    m.kind = MaterialKind::Principled;
    m.principled = {.baseColor = {0.7f, 0.4f, 0.2f},
                    .metallic = 0.4f,
                    .roughness = 0.6f,
                    .clearcoat = 0.5f,
                    .clearcoatRoughness = 0.5f,
                    .sheenColor = glm::vec3(0.3f),
                    .sheenRoughness = 0.7f};
    return m;
}

Material plasticOf(float alpha) {
    Material m;
    m.kind = MaterialKind::Plastic;
    m.albedo = {0.6f, 0.5f, 0.1f};
    m.facets = {FacetDistribution::Ggx, glm::vec2(alpha)};
    return m;
}

Material diffuseOf(const glm::vec3& albedo) {
    Material m;
    m.albedo = albedo;
    return m;
}

struct Part {
    Material material;
    float share; ///< of cases in which the next one takes its place
};

struct Mixture {
    const char* name;
    std::vector<Part> parts;
};

const std::vector<Mixture>& mixtures() {
    static const std::vector<Mixture> all = {
        {"paints", {{diffuseOf({0.8f, 0.5f, 0.1f}), 0.3f}, {diffuseOf({0.1f, 0.2f, 0.9f}), 0}}},
        {"blackAndWhite", {{diffuseOf(glm::vec3(0)), 0.5f}, {diffuseOf(glm::vec3(1)), 0}}},
        {"paintAndMetal", {{diffuseOf({0.8f, 0.5f, 0.1f}), 0.6f}, {conductorOf(0.3f), 0}}},
        {"metalAndPaint", {{conductorOf(0.5f), 0.25f}, {diffuseOf({0.8f, 0.5f, 0.1f}), 0}}},
        {"paintAndMirror", {{diffuseOf({0.3f, 0.5f, 0.1f}), 0.4f}, {mirrorOf(0.9f), 0}}},
        {"paintAndRoughGlass", {{diffuseOf({0.8f, 0.5f, 0.1f}), 0.5f}, {roughGlass(), 0}}},
        {"coatedAndSmoothPlastic", {{coated(), 0.35f}, {plasticOf(0), 0}}},
        {"three", {{plasticOf(0.3f), 0.5f}, {coated(), 0.75f}, {conductorOf(0.4f), 0}}},
        {"four",
         {{diffuseOf(glm::vec3(0.5f)), 0.9f},
          {conductorOf(0.6f), 0.5f},
          {mirrorOf(0.5f), 0.5f},
          {roughGlass(), 0}}},
    };
    return all;
}

class MixtureTest : public DeviceTest, public ::testing::WithParamInterface<size_t> {
  protected:
    MixtureTest() {
        scenes::SceneMaker b;
        for (size_t i = 0; i < parts_.size(); ++i) {
            Material m = parts_[i].material;
            if (i + 1 < parts_.size()) m.other = uint32_t(i + 1), m.otherShare = parts_[i].share;
            b.add(m);
        }
        b.sphere({0, 0, 0}, 1, 0);
        scene_ = b.scene;
        const GpuScene packed = packScene(scene_, buildWideBvh(scene_));
        EXPECT_EQ(packed.mostOthers, parts_.size() - 1);
        row_ = materialOf(packed.primitives.front());
        shader_.emplace(mixture_texel, ShaderOptions::texel()
                                           .set(SPEC_HAS_BLENDS, 1)
                                           .set(SPEC_MOST_OTHERS, packed.mostOthers));
        shader_->setScene(packed);
    }

    /// Seen from this cosine to the normals, which are one.
    gpu::BsdfQuery seenFrom(double cosine, Random& random) const {
        gpu::BsdfQuery q{};
        q.materialRow = row_;
        q.geometric = q.shading = {0, 0, 1};
        q.wo = {std::sqrt(1 - cosine * cosine), 0, cosine};
        q.outside = 1;
        q.wi = glm::normalize(random.vector());
        q.u = random.uniform(), q.v = random.uniform(), q.w = random.uniform();
        q.unused0 = uint32_t(random.uniform() * 0x1p24);
        return q;
    }

    /// The sum over the materials.
    reference::BsdfValue expected(const gpu::BsdfQuery& q, const glm::dvec3& wi) const {
        reference::BsdfValue sum;
        double left = 1;
        for (const Part& part : parts_) {
            reference::SurfacePoint s;
            s.wo = q.wo;
            s.material = &part.material;
            reference::faceForward(s, {});
            const reference::BsdfValue f = reference::evaluateBsdf(s, wi, {});
            const double share = left * (1 - double(part.share));
            sum.value += share * f.value, sum.pdf += share * f.pdf;
            left *= part.share;
        }
        return sum;
    }

    uint32_t lobes() const {
        uint32_t all = 0;
        for (const Part& part : parts_)
            all |= reference::lobesOf(part.material);
        return all;
    }

    std::vector<gpu::BsdfAnswer> answers(const std::vector<gpu::BsdfQuery>& queries) {
        return ask<gpu::BsdfAnswer>(*shader_, queries);
    }

    const std::vector<Part>& parts_ = mixtures()[GetParam()].parts;
    Scene scene_;
    uint32_t row_ = 0;
    std::optional<TestShader> shader_;
};

/// The tolerance of all tests here: that of the widest lobes, whose half vectors are known to some
/// 1e-6, and that of the fitted albedos, which are in the shares of the principled material
/// (bsdf_cases.hpp).
double toleranceOf(const std::vector<Part>& parts) {
    for (const Part& part : parts)
        if (part.material.kind == MaterialKind::Principled) return 2e-3;
    return 1e-3;
}

TEST_P(MixtureTest, ValuesAndDensitiesAreThoseOfAll) {
    Random random(301);
    std::vector<gpu::BsdfQuery> queries;
    for (int i = 0; i < 4000; ++i)
        queries.push_back(seenFrom(random.uniform(0.1f, 1), random));
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    int compared = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        if (std::abs(queries[i].wi.z) < 0.05f) continue;
        const reference::BsdfValue f = expected(queries[i], queries[i].wi);
        ASSERT_EQ(found[i].lobe >> 16, lobes());
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(found[i].value[c], f.value[c], 1e-6 + toleranceOf(parts_) * f.value[c])
                << i;
        ASSERT_NEAR(found[i].pdf, f.pdf, 1e-6 + toleranceOf(parts_) * f.pdf) << i;
        compared += f.pdf > 0;
    }
    EXPECT_GT(compared, 1000);
}

/// But those of delta lobes, whose weight is the drawn material's.
TEST_P(MixtureTest, WeightsAreValuesOverDensities) {
    Random random(302);
    std::vector<gpu::BsdfQuery> queries;
    for (int i = 0; i < 4000; ++i)
        queries.push_back(seenFrom(random.uniform(0.1f, 1), random));
    const std::vector<gpu::BsdfAnswer> found = answers(queries);
    int compared = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const gpu::BsdfAnswer& a = found[i];
        ASSERT_TRUE(a.weight == glm::vec3(0) || (a.lobe & lobes()) != 0) << "no lobe of its own";
        if ((a.lobe & gpu::DELTA_LOBES) || std::abs(a.direction.z) < 0.05f) continue;
        if (!(a.samplePdf > 0) || a.weight == glm::vec3(0)) continue;
        const reference::BsdfValue f =
            expected(queries[i], glm::normalize(glm::dvec3(a.direction)));
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(a.weight[c], f.value[c] / f.pdf,
                        2 * toleranceOf(parts_) * (1 + a.weight[c]))
                << i;
        ASSERT_NEAR(a.samplePdf, f.pdf, 1e-6 + 3 * toleranceOf(parts_) * f.pdf) << i;
        ++compared;
    }
    EXPECT_GT(compared, 1000);
}

/// In cells of the sphere, equal in z and azimuth; what is lost, or of a delta lobe, is one more.
TEST_P(MixtureTest, SamplesFallWhereTheDensityOfAllSays) {
    constexpr size_t kSamples = 100000, kRings = 20, kSectors = 12;
    // Refracted lobes are narrow, and about a pole.
    const size_t perCell = (lobes() & gpu::LOBE_GLOSSY_TRANSMISSION) != 0 ? 60 : 16;
    Random random(303);
    for (const double cosine : {0.95, 0.4}) {
        std::vector<gpu::BsdfQuery> queries;
        for (size_t i = 0; i < kSamples; ++i)
            queries.push_back(seenFrom(cosine, random));
        std::vector<double> counts(kRings * kSectors + 1, 0), wanted(counts.size(), 0);
        for (const gpu::BsdfAnswer& a : answers(queries)) {
            const glm::dvec3 w(a.direction);
            const double turn = std::atan2(w.y, w.x) / (2 * pi) + 0.5;
            const auto ring = std::min(size_t((w.z + 1) / 2 * kRings), kRings - 1);
            const auto sector = std::min(size_t(turn * kSectors), kSectors - 1);
            const bool isLost = !(a.weight.y > 0) || (a.lobe & gpu::DELTA_LOBES) != 0;
            ++counts[isLost ? kRings * kSectors : ring * kSectors + sector];
        }
        double sum = 0;
        for (size_t i = 0; i < kRings * perCell; ++i)
            for (size_t j = 0; j < kSectors * perCell; ++j) {
                const double z = 2 * (double(i) + 0.5) / double(kRings * perCell) - 1;
                const double phi = 2 * pi * ((double(j) + 0.5) / double(kSectors * perCell) - 0.5);
                const double r = std::sqrt(1 - z * z);
                const double pdf =
                    expected(queries[0], {r * std::cos(phi), r * std::sin(phi), z}).pdf;
                const double share = pdf * 4 * pi / double(kRings * perCell * kSectors * perCell);
                wanted[i / perCell * kSectors + j / perCell] += share * kSamples;
                sum += share;
            }
        constexpr double kQuadrature = 3e-5; // of the sum
        wanted.back() = std::max(1 - sum, kQuadrature) * kSamples;
        EXPECT_GT(chiSquareTest(counts, wanted), sidakLevel(0.01, 2 * mixtures().size())) << cosine;
    }
}

INSTANTIATE_TEST_SUITE_P(All, MixtureTest, ::testing::Range<size_t>(0, mixtures().size()),
                         [](const auto& c) { return mixtures()[c.param].name; });

} // namespace
} // namespace stromboli::test

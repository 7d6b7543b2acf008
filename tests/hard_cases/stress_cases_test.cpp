// The cases of `stromboli stress` in their quick size: they hold on the device and, where they are
// not about the device, on the code for the CPU; naive code fails every one of them.
#include "host/stress/case.hpp"
#include "host/stress/device_subject.hpp"
#include "tests/hard_cases/cpu_subject.hpp"
#include "tests/hard_cases/naive_intersection.hpp"
#include "tests/hard_cases/naive_subject.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <set>

namespace stromboli::stress {

/// For GoogleTest.
void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}

} // namespace stromboli::stress

namespace stromboli::test {
namespace {

using stress::Case;

stress::Finding runQuickly(const Case& which, stress::Subject& subject) {
    stress::Run run(subject, stress::Amount::Quick);
    return which.run(run);
}

std::string describe(const Case& c, const stress::Finding& f) {
    return c.property + ": " + std::to_string(f.measured) + " " + c.measure + " of " +
           std::to_string(f.trials) + " " + c.trial + ", bound " + std::to_string(f.bound) +
           "; worst: " + f.where;
}

/// "C14_C30_self_hits"
std::string nameOf(const testing::TestParamInfo<Case>& info) {
    std::string name = "C";
    for (const char c : info.param.numbers)
        name += c == ',' ? "_C" : c == ' ' ? "" : std::string(1, c);
    for (size_t i = 0; (i = name.find('C', i)) != std::string::npos; ++i)
        if (i + 2 >= name.size() || !std::isdigit(name[i + 2])) name.insert(i + 1, "0");
    name += "_" + info.param.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

std::vector<Case> casesBut(const std::set<std::string>& without) {
    std::vector<Case> cases;
    for (const Case& c : stress::allCases())
        if (!without.contains(c.name)) cases.push_back(c);
    return cases;
}

class OnDevice : public DeviceTest, public testing::WithParamInterface<Case> {};

TEST_P(OnDevice, Holds) {
    stress::DeviceSubject subject(testDevice());
    const stress::Finding f = runQuickly(GetParam(), subject);
    EXPECT_TRUE(f.passed()) << describe(GetParam(), f);
    EXPECT_GT(f.trials, 0u);
}

/// The agreement with the reference is tried below, and by tests/render with more samples.
INSTANTIATE_TEST_SUITE_P(HardCases, OnDevice, testing::ValuesIn(casesBut({"agreement"})), nameOf);

class OnCpu : public testing::TestWithParam<Case> {};

TEST_P(OnCpu, Holds) {
    CpuSubject subject;
    const stress::Finding f = runQuickly(GetParam(), subject);
    EXPECT_TRUE(f.passed()) << describe(GetParam(), f);
}

/// The others are about the kernel: its random numbers, its film, its ways to cut the work.
INSTANTIATE_TEST_SUITE_P(HardCases, OnCpu,
                         testing::ValuesIn(casesBut({"random-words", "random-neighbours", "cuts",
                                                     "bad-samples", "agreement"})),
                         nameOf);

class NaiveCode : public testing::TestWithParam<Case> {};

TEST_P(NaiveCode, Fails) {
    NaiveSubject subject;
    const stress::Finding f = runQuickly(GetParam(), subject);
    EXPECT_FALSE(f.passed()) << "negative control: " << describe(GetParam(), f);
}

/// Bundled scenes are too large for code that tries every triangle, which finds the closest hit.
INSTANTIATE_TEST_SUITE_P(HardCases, NaiveCode, testing::ValuesIn(casesBut({"agreement", "soups"})),
                         nameOf);

/// Takes the first hit that it finds.
class FirstHitTracer final : public stress::RayTracer {
  public:
    explicit FirstHitTracer(const Scene& scene) : scene_(scene) {}
    uint64_t countHits(std::span<const stress::Ray>, bool) override { return 0; }
    std::vector<float> distances(std::span<const stress::Ray> rays) override {
        std::vector<float> found;
        for (const stress::Ray& r : rays)
            found.push_back(first(r));
        return found;
    }

  private:
    float first(const stress::Ray& r) const {
        for (const Triangle& t : scene_.triangles) {
            const float found =
                naive::hitTriangle(scene_.positions[t.corner[0]], scene_.positions[t.corner[1]],
                                   scene_.positions[t.corner[2]], r.origin, r.direction);
            if (found > 0 && found < r.tMax) return found;
        }
        return stress::kMissed;
    }
    Scene scene_;
};

class FirstHitSubject final : public NaiveSubject {
  public:
    std::unique_ptr<stress::RayTracer> tracer(const Scene& scene) override {
        return std::make_unique<FirstHitTracer>(scene);
    }
};

TEST(FirstHit, C17_IsNotTheClosest) {
    FirstHitSubject subject;
    const Case soups = *std::ranges::find(stress::allCases(), "soups", &Case::name);
    EXPECT_FALSE(runQuickly(soups, subject).passed());
}

/// The product with a tenth of the light missing in one of its pictures.
class DimmedSubject final : public stress::Subject {
  public:
    DimmedSubject(stress::Subject& subject, size_t dimmed) : subject_(subject), left_(dimmed) {}
    std::unique_ptr<stress::RayTracer> tracer(const Scene& scene) override {
        return subject_.tracer(scene);
    }
    stress::Picture render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           const KernelTuning& tuning, const ProgressCallback& progress) override {
        stress::Picture picture = subject_.render(scene, camera, settings, tuning, progress);
        if (left_-- == 0)
            for (PixelStatistics& p : picture.film.pixels)
                p.mean *= 0.9, p.m2 *= 0.81;
        return picture;
    }
    std::vector<stress::RandomBlock>
    randomBlocks(std::span<const stress::Words> counters) override {
        return subject_.randomBlocks(counters);
    }
    std::vector<stress::FloatFacts> floatFacts(std::span<const stress::FloatPair> pairs) override {
        return subject_.floatFacts(pairs);
    }

  private:
    stress::Subject& subject_;
    size_t left_; ///< pictures before it
};

/// It names the first picture that does not agree: were another one wrong, that would be it.
TEST_F(DeviceTest, C62_AgreementFailsForATenthLessLightInTheLastSceneAlone) {
    const std::vector<std::string> scenes = stress::scenesThatAgree();
    stress::DeviceSubject device(testDevice());
    DimmedSubject subject(device, scenes.size() - 1);
    const Case agreement = *std::ranges::find(stress::allCases(), "agreement", &Case::name);
    const stress::Finding found = runQuickly(agreement, subject);
    EXPECT_FALSE(found.passed());
    EXPECT_EQ(found.where, scenes.back());
}

} // namespace
} // namespace stromboli::test

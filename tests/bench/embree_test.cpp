// Embree as the benchmark uses it: what it is compared with must do the same work.
#include "host/bench/embree.hpp"
#include "host/bench/ray_bench.hpp"
#include "tests/bench/bench_fixtures.hpp"

#include <gtest/gtest.h>

namespace stromboli::bench {
namespace {

using test::libraryPicture;
using test::LibraryPicture;

/// The one that all tests share.
const Embree& embree() {
    static const OpenedEmbree opened = openEmbree(2);
    if (!opened.embree) throw std::runtime_error("no Embree: " + opened.missing);
    return *opened.embree;
}

std::unique_ptr<EmbreeScene> build(const Scene& scene, EmbreeMode mode = EmbreeMode::Robust,
                                   EmbreeQuality quality = EmbreeQuality::Medium) {
    return embree().build(embree().geometry(scene), mode, quality);
}

TEST(Embree, SaysWhatItIs) {
    EXPECT_EQ(embree().version().substr(0, 2), "3.");
    EXPECT_NE(embree().compiledWith().find("-O3"), std::string::npos);
}

TEST(Embree, ModesAndQualitiesAgreeOnRays) {
    const LibraryPicture p = libraryPicture("cornell_mesh");
    const RaySets sets = makeRaySets(p.scene, p.camera, p.settings, 1);
    for (const RaySet* set : {&sets.camera, &sets.shadow, &sets.bounce}) {
        const std::vector<float> expected = build(p.scene)->distances(*set);
        for (const EmbreeMode mode : {EmbreeMode::Fast, EmbreeMode::Robust})
            for (const EmbreeQuality quality : {EmbreeQuality::Medium, EmbreeQuality::High}) {
                const auto scene = build(p.scene, mode, quality);
                const std::vector<float> found = scene->distances(*set);
                EXPECT_LE(countDisagreements(*set, expected, found), set->rays.size() / 500);
                const RayTotals totals = scene->trace(*set);
                EXPECT_GT(totals.hits, 0u);
                EXPECT_LT(totals.hits, set->rays.size());
                EXPECT_GT(scene->bytes, 50'000u * 16); // of 50,000 triangles
            }
    }
}

} // namespace
} // namespace stromboli::bench

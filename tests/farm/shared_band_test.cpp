// What a share takes of a band, with samples and camera rays that need no renderer.
#include "host/farm/round_plan.hpp"

#include "tests/farm/films.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace stromboli {
namespace {

using namespace test;

/// Every other camera ray ends on a surface, by the number of its sample.
class HalfCovered final : public Viewer {
  public:
    std::vector<SeenPixel> see(uint32_t, std::span<const uint32_t> samples, Seeing,
                               uint32_t firstSample) override {
        if (isLost) throw std::runtime_error("a viewer of a device that is lost was asked");
        std::vector<SeenPixel> seen(samples.size());
        for (size_t i = 0; i < seen.size(); ++i) {
            seen[i].samples = samples[i];
            for (uint32_t s = firstSample; s < firstSample + samples[i]; ++s)
                seen[i].hits += s % 2;
        }
        return seen;
    }
    bool isLost = false;
};

TEST(SharedBand, HasTheSamplesOfItsBlocks) {
    const FilmHeader header = ofShare(pictureOf(20, 4), {2, 2}); // blocks 2 to 4
    DrawnBackend backend(uneven, 1);
    uint64_t done = 0;
    SharedBand band(backend, header.settings.area, [&](uint64_t more) {
        done += more;
        return true;
    });
    EXPECT_TRUE(band.takeBlocks(header));
    EXPECT_EQ(band.sums(), drawBlocks(header, uneven, 1));
    EXPECT_EQ(done, 12u * kSide * kSide);
}

/// The first of several devices may drop out between two blocks: another one sees then.
TEST(SharedBand, CountsWhatIsCoveredByTheViewerThatIsLeft) {
    const FilmHeader header = ofShare(pictureOf(20, 4), {1, 1});
    DrawnBackend backend(uneven, 1);
    HalfCovered first, second;
    uint64_t done = 0;
    SharedBand band(backend, header.settings.area, [&](uint64_t more) {
        done += more;
        first.isLost = done > 6u * kSide * kSide;
        return true;
    });
    band.countCovered([&]() -> Viewer* { return first.isLost ? &second : &first; });
    EXPECT_TRUE(band.takeBlocks(header));
    EXPECT_TRUE(first.isLost);
    for (const SharedPixel& p : band.sums())
        EXPECT_EQ(p.covered, 10u);
}

TEST(SharedBand, StopsWhereItIsAskedTo) {
    const FilmHeader header = ofShare(pictureOf(20, 4), {1, 1});
    DrawnBackend backend(uneven, 1);
    SharedBand band(backend, header.settings.area, [](uint64_t) { return false; });
    EXPECT_FALSE(band.takeBlocks(header));
}

} // namespace
} // namespace stromboli

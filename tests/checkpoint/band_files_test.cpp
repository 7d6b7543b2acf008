// The checkpoints of bands: what they are called, and which of them are there.
#include "host/checkpoint/checkpoint_file.hpp"
#include "host/core/error.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace stromboli {
namespace {

void touch(const std::filesystem::path& file) {
    std::ofstream(file) << "x";
}

TEST(BandFiles, AreFoundByTheirNames) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "a.exr.checkpoint";
    EXPECT_EQ(bandsKept(file), 0u);
    EXPECT_EQ(bandFile(file, 1, 12).filename(), "a.exr.checkpoint.band2of12");
    touch(bandFile(file, 1, 12));
    touch(bandFile(file, 11, 12));
    EXPECT_EQ(bandsKept(file), 12u);
    touch(bandFile(file, 0, 3));
    EXPECT_THROW(bandsKept(file), UsageError);
    removeBandFiles(file);
    EXPECT_EQ(folder.size(), 0u);
    EXPECT_EQ(bandsKept(folder / "no folder" / "c"), 0u);
}

TEST(BandFiles, OtherNamesAreOthers) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "c";
    for (const char* name : {"c", "c.band", "c.band1", "c.band1of", "c.band0of2", "c.band3of2",
                             "c.band1of2x", "c.band1of99999999999", "c.bandxof2", "b.band1of2"})
        touch(folder / name);
    const size_t all = folder.size();
    EXPECT_EQ(bandsKept(file), 0u);
    removeBandFiles(file);
    EXPECT_EQ(folder.size(), all);
}

} // namespace
} // namespace stromboli

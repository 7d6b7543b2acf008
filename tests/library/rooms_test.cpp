#include "scene/read_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace stromboli {
namespace {

/// A bundled room, and what it has at least.
struct Room {
    const char* name;
    uint64_t triangles; ///< with those of each instance
    size_t textures;
};

class Rooms : public testing::TestWithParam<Room> {};

INSTANTIATE_TEST_SUITE_P(Bundled, Rooms,
                         testing::Values(Room{"reading_room", 35'000, 5},
                                         Room{"door_ajar", 30'000, 6}, Room{"bathroom", 40'000, 7},
                                         Room{"atrium", 1'000'000, 7}),
                         [](const auto& room) { return std::string(room.param.name); });

TEST_P(Rooms, AreReadWholeAndHaveWhatMakesThemHard) {
    const Scene scene = readScene(GetParam().name);
    EXPECT_GE(scene.placedTriangles(), GetParam().triangles);
    EXPECT_GE(scene.textures.size(), GetParam().textures);
    EXPECT_THAT(scene.report.ignored, testing::IsEmpty());
    EXPECT_THAT(scene.report.warnings, testing::IsEmpty());
    EXPECT_THAT(scene.report.forgiven, testing::IsEmpty());
    EXPECT_EQ(scene.hints.maxBounces, 16u);
    EXPECT_EQ(scene.cameras.size(), 1u);
}

} // namespace
} // namespace stromboli

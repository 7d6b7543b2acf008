// Several instances in one process: tests open them, and programs that link the libraries may.
#include "host/vulkan/device.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace stromboli::vulkan {
namespace {

/// The calls of an instance with the validation layer are not those of one without.
TEST(Instances, MayDifferInTheirLayersAndEndInAnyOrder) {
    auto checked = std::make_unique<Instance>(true);
    auto plain = std::make_unique<Instance>(false);
    EXPECT_TRUE(checked->validation());
    EXPECT_FALSE(plain->validation());
    EXPECT_FALSE(listDevices(*checked).empty());
    EXPECT_FALSE(listDevices(*plain).empty());
    EXPECT_EQ(checked->validationMessages(), 0u);
    checked.reset();
    EXPECT_FALSE(listDevices(*plain).empty());
}

} // namespace
} // namespace stromboli::vulkan

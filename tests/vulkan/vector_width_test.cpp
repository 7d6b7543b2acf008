#include "host/process/process.hpp"
#include "host/vulkan/device.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace stromboli::vulkan {
namespace {

constexpr const char* kVariable = "LP_NATIVE_VECTOR_WIDTH";

class VectorWidth : public testing::Test {
  protected:
    ~VectorWidth() override {
        before_.empty() ? unsetenv(kVariable) : setenv(kVariable, before_.c_str(), 1);
    }

  private:
    std::string before_ = std::getenv(kVariable) ? std::getenv(kVariable) : "";
};

TEST_F(VectorWidth, WhatTheUserAsksForStays) {
    setenv(kVariable, "128", 1);
    process::useWideVectors();
    EXPECT_STREQ(std::getenv(kVariable), "128");
}

TEST_F(VectorWidth, IsThatOfTheProcessor) {
    unsetenv(kVariable);
    process::useWideVectors();
    const char* width = std::getenv(kVariable);
#if defined(__x86_64__)
    EXPECT_EQ(width != nullptr, bool(__builtin_cpu_supports("avx512vl")));
#endif
    if (width) {
        EXPECT_STREQ(width, "512");
    }
}

/// Fails where the driver has been loaded before it was told, or does not listen.
TEST(VectorWidthOfTheDevice, IsAsAskedFor) {
    const DeviceDescription& device = test::testDevice().description();
    const char* width = std::getenv(kVariable);
    if (!width || device.name().find("llvmpipe") == std::string::npos)
        GTEST_SKIP() << "not llvmpipe, or of its own width";
    EXPECT_EQ(device.subgroupSize, std::stoul(width) / 32) << "lanes of 32 bits";
}

} // namespace
} // namespace stromboli::vulkan

#pragma once

#include "host/vulkan/device.hpp"
#include "host/vulkan/queue.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace stromboli::test {

/// The device that all tests of a process share, with the validation layer on: opened at the first
/// call, closed after the last test, when objects that were never destroyed fail the run.
/// Throws DeviceError if there is no usable device.
const vulkan::Device& testDevice();
/// The one queue of testDevice().
vulkan::Queue& testQueue();
/// Messages of the validation layer since testDevice() was opened.
uint32_t validationMessages();

/// A test on the device. Fails, never skips, where there is no device; fails if the validation
/// layer had anything to say during the test.
class DeviceTest : public ::testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;

  private:
    uint32_t messagesBefore_ = 0;
};

} // namespace stromboli::test

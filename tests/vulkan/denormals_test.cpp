// That threads which run kernels on a CPU take denormals for 0, and no other thread of the program
// does.
#include "host/vulkan/compute_pipeline.hpp"
#include "host/vulkan/denormals.hpp"
#include "host/vulkan/device.hpp"

#include "embedded/products_shader.h"

#include <gtest/gtest.h>

#include <bit>
#include <thread>

namespace stromboli::vulkan {
namespace {

constexpr float kDenormal = 0x1p-140f;

/// a * b, at run time.
float product(float a, float b) {
    volatile float x = a, y = b;
    return x * y;
}

float productInAThread(float a, float b) {
    float p = -1;
    std::thread([&] { p = product(a, b); }).join();
    return p;
}

/// a * b by each lane of a kernel.
std::vector<float> productsByKernel(float a, float b) {
    const OpenDevice open = openDevice("");
    std::vector<uint32_t> numbers(128, std::bit_cast<uint32_t>(a));
    std::fill(numbers.begin() + 64, numbers.end(), std::bit_cast<uint32_t>(b));
    Queue queue(*open.device);
    Buffer buffer(*open.device, "numbers", 4 * numbers.size(), BufferUse::Storage);
    buffer.upload(queue, std::as_bytes(std::span(numbers)));
    const Binding binding{0, BufferUse::Storage};
    const ComputePipeline pipeline(*open.device, products_shader, {&binding, 1}, {}, 0);
    const Buffer* const buffers[] = {&buffer};
    const DescriptorSet set(*open.device, pipeline, buffers);
    queue.run("multiply", [&](VkCommandBuffer commands) {
        recordDispatch(*open.device, commands, pipeline, set, {}, 1);
    });
    buffer.download(queue, std::as_writable_bytes(std::span(numbers)));
    std::vector<float> products;
    for (size_t i = 0; i < 64; ++i)
        products.push_back(std::bit_cast<float>(numbers[i]));
    return products;
}

class Denormals : public testing::Test {
  protected:
    void SetUp() override {
#if !defined(__SSE__) && !defined(__aarch64__)
        GTEST_SKIP() << "this processor's denormals are left as they are";
#endif
    }
};

TEST_F(Denormals, AreZeroWhileItLivesAndInThreadsStartedThen) {
    EXPECT_EQ(product(0x1p-100f, 0x1p-40f), kDenormal);
    {
        const DenormalsAreZero zero;
        EXPECT_EQ(product(0x1p-100f, 0x1p-40f), 0.0f);
        EXPECT_EQ(product(kDenormal, 0x1p100f), 0.0f);
        EXPECT_EQ(product(0x1p-63f, 0x1p-63f), 0x1p-126f) << "normal";
        EXPECT_EQ(productInAThread(0x1p-100f, 0x1p-40f), 0.0f);
    }
    EXPECT_EQ(product(0x1p-100f, 0x1p-40f), kDenormal);
    EXPECT_EQ(productInAThread(0x1p-100f, 0x1p-40f), kDenormal);
}

TEST_F(Denormals, AreZeroInKernelsOnACpu) {
    if (!openDevice("").device->description().isCpu()) GTEST_SKIP() << "no CPU device";
    EXPECT_EQ(productsByKernel(0x1p-100f, 0x1p-40f), std::vector(64, 0.0f));
    EXPECT_EQ(productsByKernel(kDenormal, 0x1p100f), std::vector(64, 0.0f));
    EXPECT_EQ(productsByKernel(0x1p-63f, 0x1p-63f), std::vector(64, 0x1p-126f));
    EXPECT_EQ(product(0x1p-100f, 0x1p-40f), kDenormal) << "in the thread that opened the device";
}

} // namespace
} // namespace stromboli::vulkan

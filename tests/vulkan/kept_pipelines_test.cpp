// That a device's pipelines are made once, and not kept without end. No device is needed.
#include "host/vulkan/compute_pipeline.hpp"
#include "host/vulkan/pipeline_cache.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace stromboli::vulkan {
namespace {

class Kept : public testing::Test {
  protected:
    KeptPipelines::Made get(uint64_t key) {
        return kept_.get({key, 7}, [&] {
            ++made_;
            return std::make_shared<const CompiledPipeline>();
        });
    }

    KeptPipelines kept_;
    int made_ = 0;
};

TEST_F(Kept, TheSameKeyIsMadeOnce) {
    const auto first = get(1), other = get(2);
    EXPECT_NE(first, other);
    EXPECT_EQ(get(1), first);
    EXPECT_EQ(get(2), other);
    EXPECT_EQ(made_, 2);
}

TEST_F(Kept, FailuresAreNotKept) {
    EXPECT_THROW(
        kept_.get({3}, []() -> KeptPipelines::Made { throw std::runtime_error("no memory"); }),
        std::runtime_error);
    bool tried = false;
    kept_.get({3}, [&] {
        tried = true;
        return std::make_shared<const CompiledPipeline>();
    });
    EXPECT_TRUE(tried);
}

TEST_F(Kept, ManyAreForgottenButForThoseInUse) {
    const auto inUse = get(0);
    std::weak_ptr<const CompiledPipeline> unused = get(1);
    for (uint64_t key = 2; key < KeptPipelines::kMost; ++key)
        get(key);
    EXPECT_FALSE(unused.expired());
    get(KeptPipelines::kMost);
    EXPECT_TRUE(unused.expired());
    EXPECT_EQ(inUse.use_count(), 1);
    EXPECT_NE(get(0), inUse) << "it was forgotten";
}

} // namespace
} // namespace stromboli::vulkan

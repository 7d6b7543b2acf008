#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli::test {

using gpu::TextureAnswer;
using gpu::TextureQuery;

inline constexpr uint32_t kTextureWidth = 5, kTextureHeight = 3;

/// How many textures are stored so that a row holds what is looked up together.
enum class Gathered { All, Some, None };

struct TextureStorage {
    bool texelBuffers;
    Gathered gathered;
};

/// Textures of all kinds, asked for what the kernel looks up.
class TextureLookup : public DeviceTest, public testing::WithParamInterface<TextureStorage> {
  protected:
    /// One triangle for each kind of texture.
    void SetUp() override;

    void pack(); ///< scene_
    std::vector<TextureAnswer> ask(const std::vector<TextureQuery>& queries) const;

    /// The definition.
    glm::dvec4 expected(const TextureUse& use, double u, double v) const;

    Scene scene_;
    GpuScene packed_;
    std::vector<uint32_t> rowOf_; ///< of each primitive's texture
    std::vector<TextureUse> textureOf_;
};

} // namespace stromboli::test

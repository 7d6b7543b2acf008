#pragma once

#include "host/vulkan/buffer.hpp"
#include "host/vulkan/compute_pipeline.hpp"
#include "shaders/shared/interface.h"
#include "shaders/shared/render_types.h"
#include "tests/support/numbers.hpp"

#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {
struct GpuScene;
}

namespace stromboli::test {

/// Bindings of test shaders beside those of the path kernel, which keep their numbers.
inline constexpr uint32_t kQueryBinding = BINDING_COUNT;
inline constexpr uint32_t kAnswerBinding = BINDING_COUNT + 1;

/// How a test shader is specialised. As it stands, everything is switched on and all conventions
/// are those of physics.
struct ShaderOptions {
    ShaderOptions();
    /// For a shader that was compiled with FETCH_TEXEL.
    static ShaderOptions texel();
    ShaderOptions& set(uint32_t constant, uint32_t value);

    std::array<uint32_t, SPEC_COUNT> constants{}; ///< by SPEC_ number
    bool texelFetch = false;
};

/// A compute shader on the test device with every binding of the path kernel, a buffer of queries
/// and one of answers (tests/shaders/prelude.glsl). Buffers that are not set hold 16 zero bytes.
class TestShader {
  public:
    explicit TestShader(std::span<const uint32_t> spirv, const ShaderOptions& options = {});

    /// Replaces a buffer's contents, size included.
    void setBytes(uint32_t binding, std::span<const std::byte> bytes);
    template <class T>
    void set(uint32_t binding, const std::vector<T>& rows) {
        setBytes(binding, std::as_bytes(std::span(rows)));
    }
    template <class T>
    void setOne(uint32_t binding, const T& value) {
        setBytes(binding, std::as_bytes(std::span(&value, 1)));
    }
    /// Sets the scene's buffers, and what the frame constants say of the scene.
    void setScene(const GpuScene& scene);

    /// Runs `invocations` invocations; `constants.itemCount` is set to that number.
    void run(uint32_t invocations, gpu::Dispatch constants = {});

    /// The first `count` values of type T of a buffer.
    template <class T>
    std::vector<T> get(uint32_t binding, size_t count) {
        std::vector<T> values(count);
        getBytes(binding, std::as_writable_bytes(std::span(values)));
        return values;
    }

  private:
    void getBytes(uint32_t binding, std::span<std::byte> bytes);

    vulkan::ComputePipeline pipeline_;
    uint32_t groupSize_;
    std::vector<std::optional<vulkan::Buffer>> buffers_; ///< by binding
};

/// Runs the shader with one invocation per query; each writes one answer.
template <class Answer, class Query>
std::vector<Answer> ask(TestShader& shader, const std::vector<Query>& queries,
                        const gpu::Dispatch& constants = {}) {
    shader.set(kQueryBinding, queries);
    shader.set(kAnswerBinding, std::vector<Answer>(queries.size()));
    shader.run(uint32_t(queries.size()), constants);
    return shader.get<Answer>(kAnswerBinding, queries.size());
}

/// Runs a shader that is used once and needs no other buffers.
template <class Answer, class Query>
std::vector<Answer> ask(std::span<const uint32_t> spirv, const std::vector<Query>& queries,
                        const ShaderOptions& options = {}) {
    TestShader shader(spirv, options);
    return ask<Answer>(shader, queries);
}

} // namespace stromboli::test

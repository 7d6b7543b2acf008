#include "tests/shaders/texture_lookup.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/core/random.hpp"
#include "scene/model/surface_lookup.hpp"
#include "shaders/shared/texture_types.h"
#include "tests/analytic/textured.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/texture_storage.h"
#include "embedded/texture_texel.h"

#include <cmath>

namespace stromboli::test {
namespace {

/// Index of a texel of the picture that goes on for ever.
uint32_t wrappedIndex(int64_t i, Wrap wrap, int64_t n) {
    if (wrap == Wrap::Clamp) return uint32_t(std::clamp<int64_t>(i, 0, n - 1));
    const int64_t period = wrap == Wrap::Mirror ? 2 * n : n;
    const int64_t within = (i % period + period) % period;
    return uint32_t(within < n ? within : period - 1 - within);
}

uint64_t gatheredRows(Gathered gathered) {
    // Some: the first two pictures of the fixture, with three wraps of each direction.
    constexpr uint64_t kRows = uint64_t(kTextureHeight + 1) * (kTextureWidth + 2) * 18;
    return gathered == Gathered::All ? kUsualGatheredRows : gathered == Gathered::Some ? kRows : 0;
}

} // namespace

void TextureLookup::SetUp() {
    DeviceTest::SetUp();
    Random random(7);
    SceneMaker b;
    TextureMaker t(b.scene);
    std::vector<glm::vec4> texels;
    for (uint32_t i = 0; i < kTextureWidth * kTextureHeight; ++i)
        texels.emplace_back(random.uniform(), random.uniform(), random.uniform(), random.uniform());
    texels[4].x = 0.004f; // which a half float tells more exactly than a fraction does
    std::vector<glm::vec4> fractions;
    for (const glm::vec4& texel : texels)
        fractions.push_back(glm::max(texel, glm::vec4(0.02f)));
    const uint32_t images[] = {t.bytes(kTextureWidth, kTextureHeight, texels),
                               t.halves(kTextureWidth, kTextureHeight, texels),
                               t.halves(kTextureWidth, kTextureHeight, fractions)};
    const uint32_t one = t.bytes(1, 1, {texels[0]});
    for (const uint32_t image : {images[0], images[1], images[2], one})
        for (const Wrap u : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
            for (const Wrap v : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
                for (const bool nearest : {false, true})
                    for (const bool srgb : {false, true})
                        if (!srgb || (image != images[1] && image != images[2]))
                            t.texture({.image = image,
                                       .wrapU = u,
                                       .wrapV = v,
                                       .nearest = nearest,
                                       .srgb = srgb});
    // A material for each, as a material has one texture of a slot.
    for (uint32_t i = 0; i < b.scene.textures.size(); ++i) {
        Material m;
        m.textures = {{.slot = TextureSlot::BaseColor,
                       .texture = i,
                       .uRow = {0.5f, 0.25f, -0.125f},
                       .vRow = {-0.75f, 1, 0.5f}}};
        b.triangle({0, 0, float(i)}, {1, 0, float(i)}, {0, 1, float(i)}, b.add(m));
        t.attributes(1, [](const glm::vec3& p) {
            VertexAttributes a;
            a.uv[0] = {p.x, p.y};
            return a;
        });
    }
    scene_ = b.scene;
    pack();
    ASSERT_TRUE(packed_.texelKinds & gpu::TEXEL_KIND_HALF);
    const uint32_t kinds = gpu::TEXEL_KIND_PLAIN | gpu::TEXEL_KIND_GATHERED;
    ASSERT_EQ(packed_.texelKinds & kinds,
              GetParam().gathered == Gathered::All    ? gpu::TEXEL_KIND_GATHERED
              : GetParam().gathered == Gathered::None ? gpu::TEXEL_KIND_PLAIN
                                                      : kinds);
    for (const gpu::Primitive& p : packed_.primitives)
        rowOf_.push_back(materialOf(p) + gpu::MATERIAL_DETAIL_ROW + 1);
    for (size_t i = 0; i < rowOf_.size(); ++i)
        textureOf_.push_back(
            scene_.materials[scene_.triangles[packed_.bvh.primitiveOrder[i]].material].textures[0]);
}

void TextureLookup::pack() {
    packed_ = packScene(scene_, buildWideBvh(scene_), {}, {}, gatheredRows(GetParam().gathered));
}

std::vector<TextureAnswer> TextureLookup::ask(const std::vector<TextureQuery>& queries) const {
    ShaderOptions options = GetParam().texelBuffers ? ShaderOptions::texel() : ShaderOptions();
    options.set(SPEC_TEXEL_KINDS, packed_.texelKinds).set(SPEC_ATTRIBUTES, packed_.attributes);
    options.set(SPEC_TEXTURE_SLOTS, packed_.textureSlots);
    options.set(SPEC_LOOSE_SLOTS, packed_.looseSlots);
    options.set(SPEC_LOOSE_TEXTURES, packed_.mostTextures);
    TestShader shader(GetParam().texelBuffers ? std::span<const uint32_t>(texture_texel)
                                              : std::span<const uint32_t>(texture_storage),
                      options);
    shader.setScene(packed_);
    return test::ask<TextureAnswer>(shader, queries);
}

glm::dvec4 TextureLookup::expected(const TextureUse& use, double u, double v) const {
    const Texture& t = scene_.textures[use.texture];
    const TextureImage& image = scene_.images[t.image];
    const glm::dvec3 uv1(u, v, 1);
    const double x = glm::dot(glm::dvec3(use.uRow), uv1) * image.width,
                 y = glm::dot(glm::dvec3(use.vRow), uv1) * image.height;
    const auto texel = [&](int64_t i, int64_t j) {
        return texelAt(image, t.srgb, wrappedIndex(i, t.wrapU, image.width),
                       wrappedIndex(j, t.wrapV, image.height));
    };
    if (t.nearest) return texel(int64_t(std::floor(x)), int64_t(std::floor(y)));
    glm::dvec4 sum(0.0);
    for (int64_t j = int64_t(std::floor(y)) - 2; j <= int64_t(std::floor(y)) + 2; ++j)
        for (int64_t i = int64_t(std::floor(x)) - 2; i <= int64_t(std::floor(x)) + 2; ++i)
            sum += std::max(0.0, 1 - std::abs(x - 0.5 - double(i))) *
                   std::max(0.0, 1 - std::abs(y - 0.5 - double(j))) * texel(i, j);
    return sum;
}

} // namespace stromboli::test

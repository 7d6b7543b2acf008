// Media among the rows of materials, and the bounds of densities by which their grids are tracked.
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/medium_rows.hpp"
#include "scene/generate/scene_maker.hpp"
#include "shaders/shared/medium_types.h"

#include <gtest/gtest.h>

#include <random>

namespace stromboli {
namespace {

DensityGrid randomGrid(std::mt19937& random, const glm::uvec3& size) {
    DensityGrid grid;
    grid.size = size;
    for (uint32_t i = 0; i < size.x * size.y * size.z; ++i)
        grid.values.push_back(random() % 4 == 0 ? float(random() % 1000) : 0.0f);
    return grid;
}

/// Anywhere in a block, and as far beyond its faces as the rounding of places goes.
TEST(MediumRows, BlocksBoundTheDensity) {
    std::mt19937 random(1);
    const auto fraction = [&] { return double(random()) / 4294967296.0; };
    for (const glm::uvec3& size :
         {glm::uvec3(1, 1, 1), glm::uvec3(2, 3, 16), glm::uvec3(17, 40, 5)}) {
        const DensityGrid grid = randomGrid(random, size);
        const DensityBounds bounds = boundDensity(grid);
        ASSERT_EQ(bounds.most.size(), size_t(bounds.blocks.x * bounds.blocks.y * bounds.blocks.z));
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_EQ(bounds.blocks[axis], std::min(size[axis], gpu::MOST_BLOCKS));
        for (int i = 0; i < 20'000; ++i) {
            const glm::uvec3 block(random() % bounds.blocks.x, random() % bounds.blocks.y,
                                   random() % bounds.blocks.z);
            glm::dvec3 place;
            for (int axis = 0; axis < 3; ++axis) {
                const double beyond = 1e-5 * (fraction() - 0.5);
                place[axis] =
                    std::clamp((block[axis] + fraction()) / bounds.blocks[axis] + beyond, 0.0, 1.0);
            }
            const size_t index =
                block.x + bounds.blocks.x * (block.y + size_t(bounds.blocks.y) * block.z);
            EXPECT_LE(grid.at(place), double(bounds.most[index]) * (1 + 1e-6));
        }
    }
}

/// Of every channel, whatever the medium's own colour.
TEST(MediumRows, OneNumberBoundsAllChannels) {
    std::mt19937 random(2);
    const auto fraction = [&] { return double(random()) / 4294967296.0; };
    Medium m;
    m.absorption = {0.5f, 2, 0};
    m.scattering = {0.25f, 1, 0.125f};
    ColorGrid& colors = m.colors.extinction.emplace();
    colors.size = {3, 5, 2};
    for (int i = 0; i < 30; ++i)
        colors.values.emplace_back(random() % 100, random() % 20, random() % 300);
    const DensityGrid bound = m.bound();
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 place(fraction(), fraction(), fraction());
        const glm::dvec3 extinction = m.at(place, place).extinction;
        for (int c = 0; c < 3; ++c)
            EXPECT_LE(extinction[c], 3 * bound.at(place) * (1 + 1e-6));
    }
}

/// A scene whose media nothing is in contact with is packed as if it had none.
TEST(MediumRows, AreOnlyWhereAMediumIs) {
    scenes::SceneMaker maker;
    maker.box({-1, -1, -1}, {1, 1, 1}, maker.add(scenes::diffuse(0.5f)), true);
    const GpuScene without = packScene(maker.scene, buildWideBvh(maker.scene));
    EXPECT_EQ(without.media, 0u);
    maker.scene.media.push_back(Medium{});
    resolveMedia(maker.scene);
    const GpuScene unused = packScene(maker.scene, buildWideBvh(maker.scene));
    EXPECT_EQ(unused.materials, without.materials);
    Medium fog;
    fog.scattering = glm::vec3(1);
    fog.emission = glm::vec3(1);
    maker.scene.media.push_back(fog);
    maker.scene.surrounding = 0;
    const GpuScene filled = packScene(maker.scene, buildWideBvh(maker.scene));
    EXPECT_EQ(filled.media, gpu::MEDIA_DIM | gpu::MEDIA_SCATTER | gpu::MEDIA_SHINE);
    EXPECT_NE(filled.closures.some & gpu::PHASE_FUNCTION, 0u);
}

/// Every border names the first rows of its media.
TEST(MediumRows, BordersNameTheirMedia) {
    scenes::SceneMaker maker;
    maker.scene.media.resize(2);
    maker.scene.media[1].scattering = glm::vec3(1, 2, 3);
    maker.scene.media[1].absorption = glm::vec3(1);
    Material border = scenes::diffuse(0.5f);
    border.boundsMedia = true;
    border.inside = 1;
    maker.sphere({0, 0, 0}, 1, maker.add(scenes::diffuse(0)));
    maker.sphere({0, 0, 0}, 2, maker.add(border));
    const MaterialRows rows = packMaterials(maker.scene.materials, {}, maker.scene.media);
    const auto borderOf = [&](size_t material) {
        return structureAt<gpu::MediumBorder>(rows.rows,
                                              rows.firstRow[material] - gpu::MEDIUM_BORDER_ROWS);
    };
    EXPECT_EQ(borderOf(0).isBorder, 0u);
    EXPECT_EQ(borderOf(1).isBorder, 1u);
    EXPECT_EQ(borderOf(1).inside, rows.media.firstRow[1]);
    EXPECT_EQ(borderOf(1).outside, gpu::NO_MEDIUM);
    const auto body =
        structureAt<gpu::MediumBody>(rows.rows, borderOf(1).inside + gpu::MEDIUM_BODY_ROW);
    EXPECT_EQ(body.extinction, glm::vec3(2, 3, 4));
    EXPECT_EQ(body.albedo, glm::vec3(0.5f, 2 / 3.0f, 0.75f));
    EXPECT_EQ(body.mostExtinction, 4);
}

} // namespace
} // namespace stromboli

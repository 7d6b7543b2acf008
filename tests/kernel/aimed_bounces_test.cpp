// Bounces that aim at what lamps light, and at glass about lamps: which cells are found, which
// lamps are left to them, and pictures: no bias by any cells, less noise where a lamp stands in a
// shade or in a globe, the same bytes however the work is cut.
#include "host/kernel/find_lit_cells.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/lamp_light.hpp"
#include "host/kernel/light_table.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/kernel/window_room.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace stromboli {
namespace {

using namespace test;

struct Room {
    bool hasShade = true, hasSky = false, hasSpot = false, lampIsMesh = false;
    MaterialKind floor = MaterialKind::Diffuse;
    float roughness = 0;     ///< of the floor, where it has facets
    float globe = 0;         ///< radius of one of glass about the lamp, 0.9 of it hollow; 0: none
    float lamp = 0.04f;      ///< its radius
    bool hasPanel = false;   ///< in the middle, with 25 times the light of the lamp
    bool globeLeaks = false; ///< it is a cube of panes, which is open above
};

/// Glass about the lamp: a hollow sphere with a socket in it, or panes.
void addGlobe(scenes::SceneMaker& b, const glm::vec3& at, const Room& room) {
    Material glass;
    glass.kind = MaterialKind::Dielectric;
    glass.ior = 1.5f;
    const uint32_t shell = b.add(glass);
    glass.ior = 1 / 1.5f;
    if (!room.globeLeaks) {
        const float half = 0.2f * room.globe; // of the socket
        b.quad(at - glm::vec3(half, 0.8f * room.globe, half), {0, 0, 2 * half}, {2 * half, 0, 0},
               b.add(scenes::diffuse(0.6f)));
        b.sphere(at, room.globe, shell);
        b.sphere(at, 0.9f * room.globe, b.add(glass));
        return;
    }
    const float side = 2 * room.globe;
    const glm::vec3 low = at - glm::vec3(room.globe), x(side, 0, 0), y(0, side, 0), z(0, 0, side);
    glass.kind = MaterialKind::ThinDielectric;
    const uint32_t pane = b.add(glass);
    b.quad(low, z, x, pane), b.quad(low, y, z, pane), b.quad(low + x, z, y, pane);
    b.quad(low, x, y, pane), b.quad(low + z, y, x, pane); // open above
}

/// A closed box of side 2 about the origin, in which a lamp stands in a shade that is open above.
Scene roomWithLamp(const Room& room) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f));
    Material other = scenes::diffuse(0.6f);
    other.kind = room.floor;
    other.facets.alpha = glm::vec2(room.roughness);
    const uint32_t floor = room.floor == MaterialKind::Diffuse ? white : b.add(other);
    const auto box = [&](const glm::vec3& low, const glm::vec3& size, bool isOpen, uint32_t under) {
        const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
        b.quad(low, z, x, under);
        if (!isOpen) b.quad(low + y, x, z, white);
        b.quad(low, y, z, white), b.quad(low + x, z, y, white);
        b.quad(low, x, y, white), b.quad(low + z, y, x, white);
    };
    box({-1, -1, -1}, {2, 2, 2}, false, floor);
    const uint32_t shine = b.add(scenes::emissive(100));
    const glm::vec3 at(-0.7f, -0.2f, -0.7f);
    if (room.lampIsMesh)
        b.quad(at - glm::vec3(0.04f, 0, 0.04f), {0, 0, 0.08f}, {0.08f, 0, 0}, shine);
    else
        b.sphere(at, room.lamp, shine);
    if (room.globe > 0) addGlobe(b, at, room);
    if (room.hasPanel) b.quad({-0.2f, 0.2f, -0.2f}, {0.5f, 0, 0}, {0, 0, 0.5f}, shine);
    if (room.hasShade) box(at - glm::vec3(0.1f, 0.1f, 0.1f), {0.2f, 0.3f, 0.2f}, true, white);
    if (room.hasSky) b.scene.lights.emplace_back().kind = LightKind::Ambient;
    if (room.hasSpot) b.scene.lights.emplace_back().kind = LightKind::Point;
    return b.scene;
}

GpuScene packed(const Scene& scene, const Estimator& estimator = {}) {
    return packScene(scene, buildWideBvh(scene), lightSelection(estimator));
}

double areaOf(const Scene& scene, size_t triangle) {
    const auto& c = scene.triangles[triangle].corner;
    const glm::dvec3 p = scene.positions[c[0]], q = scene.positions[c[1]],
                     r = scene.positions[c[2]];
    return 0.5 * glm::length(glm::cross(q - p, r - p));
}

/// Cells of a triangle that its squares beyond the diagonal have not.
bool isInTriangle(uint32_t cell, uint32_t level) {
    const uint32_t side = 1u << level, square = cell / 2;
    return square / side + square % side + cell % 2 < side;
}

/// Any cells of every third triangle, and of spheres, with probabilities that differ a
/// thousandfold.
LitCells anyCells(const Scene& scene, const GpuScene& gpu) {
    Random random(31);
    LitCells lit;
    lit.ofPlace.assign((2 * gpu.bvh.records.size() + 3) / 4 * 4, gpu::NO_CELLS);
    std::vector<double> weights, areas;
    for (size_t t = 0; t < scene.triangles.size(); t += 3) {
        if (scene.materials[scene.triangles[t].material].emission != glm::vec3(0)) continue;
        const uint32_t place = gpu.bvh.placeOf[t], level = random.below(4);
        lit.ofPlace[place] = uint32_t(weights.size()) << gpu::CELLS_LEVEL_BITS | level;
        for (uint32_t cell = 0; cell < 2u << 2 * level; ++cell) {
            const bool isThere = isInTriangle(cell, level) && random.uniform() < 0.7f;
            weights.push_back(isThere ? random.ofAnySize(1e-3f, 1) : 0);
            areas.push_back(areaOf(scene, t) / double(1u << 2 * level));
            lit.cells.push_back({0, 0, place, 0});
        }
    }
    for (size_t i = 0; i < scene.spheres.size(); ++i) {
        if (scene.materials[scene.spheres[i].material].emission != glm::vec3(0)) continue;
        const uint32_t place = gpu.bvh.placeOf[scene.triangles.size() + i];
        lit.ofPlace[place] = uint32_t(weights.size()) << gpu::CELLS_LEVEL_BITS;
        weights.insert(weights.end(), {0.5, 0});
        areas.insert(areas.end(), {1, 1}); // by solid angle
        lit.cells.insert(lit.cells.end(), 2, {0, 0, place, 0});
    }
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<AliasColumn> columns = buildAliasTable(weights);
    for (size_t i = 0; i < weights.size(); ++i) {
        lit.cells[i].threshold = float(columns[i].threshold);
        lit.cells[i].alias = columns[i].alias;
        lit.cells[i].density = float(weights[i] / areas[i] / all);
    }
    return lit;
}

TEST(LitCells, AreWhereTheLightOfALampInAShadeLands) {
    for (const bool isMesh : {false, true}) {
        const Scene scene = roomWithLamp({.lampIsMesh = isMesh});
        const GpuScene gpu = packed(scene);
        const LitCells lit = findLitCells(gpu);
        ASSERT_FALSE(lit.cells.empty());
        double inShade = 0, all = 0;
        for (size_t t = 0; t < scene.triangles.size(); ++t) {
            const uint32_t cells = lit.ofPlace[gpu.bvh.placeOf[t]];
            if (cells == gpu::NO_CELLS) continue;
            const uint32_t level = cells & ((1u << gpu::CELLS_LEVEL_BITS) - 1);
            const double area = areaOf(scene, t) / double(1u << 2 * level);
            for (uint32_t cell = 0; cell < 2u << 2 * level; ++cell) {
                const gpu::LitCell& c = lit.cells.at((cells >> gpu::CELLS_LEVEL_BITS) + cell);
                EXPECT_EQ(c.place, gpu.bvh.placeOf[t]);
                EXPECT_TRUE(c.density == 0 || isInTriangle(cell, level));
                all += double(c.density) * area;
                if (areaOf(scene, t) < 0.1) inShade += double(c.density) * area;
            }
        }
        EXPECT_NEAR(all, 1, 1e-5) << "a density";
        EXPECT_GT(inShade, 0.6);
        EXPECT_LT(inShade, 0.95) << "the shade is open above";
    }
}

TEST(LitCells, AreNoneWhereBouncesFindTheLight) {
    const auto none = [](const Room& room) {
        return findLitCells(packed(roomWithLamp(room))).cells.empty();
    };
    EXPECT_TRUE(none({.hasShade = false}));
    EXPECT_TRUE(none({.hasSky = true})) << "it is not known what the sky brings";
    EXPECT_TRUE(none({.hasSpot = true}));
    EXPECT_TRUE(findLitCells(packed(scenes::SceneMaker().scene)).cells.empty());
}

/// By whatever factor a scene is larger, bounces aim alike; where floats cannot hold a density by
/// area, they do not aim.
TEST(LitCells, AreTheSameAtAnyScale) {
    const auto cells = [](float scale) {
        Scene scene = roomWithLamp({.lampIsMesh = true});
        for (glm::vec3& p : scene.positions)
            p *= scale;
        return findLitCells(packed(scene)).cells;
    };
    const auto atOne = cells(1);
    for (const float scale : {0x1p-30f, 0x1p30f}) {
        const auto scaled = cells(scale);
        ASSERT_EQ(scaled.size(), atOne.size());
        for (size_t i = 0; i < atOne.size(); ++i) {
            EXPECT_EQ(scaled[i].place, atOne[i].place);
            EXPECT_EQ(scaled[i].alias, atOne[i].alias);
            EXPECT_EQ(scaled[i].density, atOne[i].density / scale / scale);
        }
    }
    EXPECT_TRUE(cells(0x1p60f).empty());
}

TEST(LitCells, AreLookedForAnewWhenMaterialsChange) {
    const Scene scene = roomWithLamp({});
    GpuScene gpu = packed(scene);
    EXPECT_FALSE(gpu.lit) << "packScene() leaves that to others";
    gpu.lit = findLitCells(gpu);
    Estimator estimator;
    EXPECT_TRUE(aimsBounces(gpu, estimator));
    estimator.gapProposal = false;
    EXPECT_FALSE(aimsBounces(gpu, estimator)) << "--gap-proposal off";
    repackMaterials(gpu, scene, lightSelection({}));
    EXPECT_FALSE(gpu.lit);
    EXPECT_FALSE(aimsBounces(gpu, {}));
}

/// Light samples do not pass glass: what a lamp sends through it is aimed at where it leaves the
/// outermost of the glass about the lamp.
TEST(LitCells, AreTheGlassAboutALamp) {
    const Scene scene = roomWithLamp({.hasShade = false, .globe = 0.1f});
    const GpuScene gpu = packed(scene);
    const LitCells lit = findLitCells(gpu);
    const size_t spheres = scene.triangles.size(); // the lamp, the globe, its hollow
    const uint32_t cells = lit.ofPlace.at(gpu.bvh.placeOf[spheres + 1]);
    ASSERT_NE(cells, gpu::NO_CELLS);
    EXPECT_EQ(lit.ofPlace[gpu.bvh.placeOf[spheres + 2]], gpu::NO_CELLS) << "the inner one";
    EXPECT_GT(lit.cells.at(cells >> gpu::CELLS_LEVEL_BITS).density, 0.8f) << "by solid angle";
    EXPECT_EQ(lit.cells.at((cells >> gpu::CELLS_LEVEL_BITS) + 1).density, 0) << "that is none";
    const LitCells alone =
        findLitCells(packed(roomWithLamp({.hasShade = false, .globe = 0.1f, .hasPanel = true})));
    EXPECT_EQ(alone.cells.size(), 2u) << "light samples find the light of the panel";
    const LitCells panes =
        findLitCells(packed(roomWithLamp({.hasShade = false, .globe = 0.1f, .globeLeaks = true})));
    EXPECT_FALSE(panes.cells.empty());
    EXPECT_TRUE(
        findLitCells(packed(roomWithLamp({.hasShade = false, .globe = 0.9f}))).cells.empty())
        << "glass that is as large as the room is no brighter than the room";
}

/// A ray of light that goes through the glass about its lamp and then through a far pane has left
/// the lamp's glass at the lamp.
TEST(LampLight, LeavesTheGlassAboutItsLamp) {
    scenes::SceneMaker b;
    Material glass;
    glass.kind = MaterialKind::ThinDielectric;
    const uint32_t pane = b.add(glass), white = b.add(scenes::diffuse(0.5f));
    const auto across = [&](float x, uint32_t material) {
        b.quad({x, -1, -1}, {0, 2, 0}, {0, 0, 2}, material);
    };
    across(1, pane), across(3, pane), across(20, pane), across(25, white);
    const GpuScene gpu = packed(b.scene);
    const LightPath path = followLight(gpu, {.origin = {0, 0.1f, 0.2f}, .direction = {1, 0, 0}});
    EXPECT_EQ(path.glass.point.x, 3) << "at most four times as far as the pane before it";
    EXPECT_EQ(path.surface.point.x, 25);
    EXPECT_EQ(path.surface.normal.x, -1) << "to where the light comes from";
}

TEST(LampLight, OfLampsInClearGlassIsLeftToBounces) {
    const Room globe{.hasShade = false, .globe = 0.1f};
    EXPECT_EQ(packed(roomWithLamp(globe)).lights.count, 0u);
    EXPECT_EQ(packed(roomWithLamp(globe)).lights.leftToBounces.size(), 1u);
    const auto counted = [](Room room, DirectLight mode = DirectLight::Mis) {
        Estimator estimator;
        estimator.directLight = mode;
        const Scene scene = roomWithLamp(room);
        return packScene(scene, buildWideBvh(scene), lightSelection(estimator)).lights.count;
    };
    EXPECT_EQ(counted(globe, DirectLight::MisAll), 0u);
    EXPECT_EQ(counted(globe, DirectLight::Lights), 1u) << "bounces do not look for it";
    EXPECT_EQ(counted({.hasShade = true}), 1u);
    EXPECT_EQ(counted({.hasShade = false, .hasSky = true, .globe = 0.1f}), 1u)
        << "and the sky is left to bounces";
    Room leaks = globe;
    leaks.globeLeaks = true;
    EXPECT_EQ(counted(leaks), 1u) << "some light does not meet glass";
    leaks.lampIsMesh = true;
    EXPECT_EQ(counted(leaks), 1u) << "a lamp that shines up only, out of the panes";
}

class AimedBounces : public DeviceTest {
  protected:
    AimedBounces() {
        settings_.area.width = 48, settings_.area.height = 36;
        settings_.budget.mostSamplesPerPixel = 64;
        settings_.estimator.maxBounces = 4;
    }

    /// cells: any, where none are given.
    Film pictureOf(const Scene& loaded, bool aims, const std::optional<LitCells>& cells = {},
                   const KernelTuning& tuning = {}) {
        settings_.estimator.gapProposal = aims;
        GpuScene scene = packed(loaded, settings_.estimator);
        scene.lit = cells ? *cells : anyCells(loaded, scene);
        VulkanBackend backend(testDevice(), scene, view_, settings_, tuning);
        EXPECT_EQ(backend.features()[SPEC_AIMS_BOUNCES], aims ? 1u : 0u);
        return render(backend, settings_);
    }

    static double noiseOf(const Film& film) {
        double sum = 0;
        for (const auto& pixel : film.pixels)
            sum += pixel.m2.y;
        return sum;
    }

    Camera view_ = lookingAt({0.9, 0.6, 0.9}, {-0.5, -0.6, -0.5}, 0.9);
    RenderSettings settings_;
};

/// Independent samples, so that variances are right.
TEST_F(AimedBounces, AnyCellsHaveNoBias) {
    settings_.estimator.sampler = Sampler::Independent;
    const auto expectNoBias = [&](const Room& room, const std::string& what) {
        const Scene scene = roomWithLamp(room);
        settings_.estimator.seed = 0;
        const Film plain = pictureOf(scene, false);
        settings_.estimator.seed = 1;
        expectAgreement(plain, pictureOf(scene, true), what);
    };
    settings_.budget.mostSamplesPerPixel = 512;
    expectNoBias({.hasShade = false}, "light samples alone find the lamp");
    settings_.estimator.directLight = DirectLight::MisAll;
    expectNoBias({.hasShade = false, .lampIsMesh = true}, "bounces find it too");
    settings_.estimator.branches = 4;
    settings_.budget.mostSamplesPerPixel = 256;
    using enum MaterialKind;
    expectNoBias({.hasShade = false, .floor = Plastic}, "plastic, branches");
    expectNoBias({.hasShade = false, .floor = Plastic, .roughness = 0.3f}, "rough plastic");
    expectNoBias({.hasShade = false, .floor = Principled}, "glTF's materials");
    expectNoBias({.hasShade = false, .floor = Principled, .globe = 0.28f, .lamp = 0.2f}, "glass");
}

/// Light of a lamp in glass, which light samples are not sent to, against bounces alone, which are
/// sent nowhere.
TEST_F(AimedBounces, LampsThatAreLeftToThemHaveNoBias) {
    settings_.estimator.sampler = Sampler::Independent;
    settings_.budget.mostSamplesPerPixel = 512;
    const Scene scene = roomWithLamp({.hasShade = false, .globe = 0.28f, .lamp = 0.2f});
    const GpuScene gpu = packed(scene);
    EXPECT_EQ(gpu.lights.count, 0u);
    const Film left = pictureOf(scene, true, findLitCells(gpu));
    EXPECT_NE(kernelFeatures(gpu, view_, settings_.estimator, {})[SPEC_MIS_LOBES] &
                  gpu::DIFFUSE_LOBES,
              0u)
        << "of bounces within the glass";
    settings_.estimator.seed = 1;
    settings_.estimator.directLight = DirectLight::Bsdf;
    GpuScene plain = packed(scene, settings_.estimator);
    VulkanBackend backend(testDevice(), plain, view_, settings_);
    expectAgreement(left, render(backend, settings_), "a lamp in a globe");
}

TEST_F(AimedBounces, HaveLessNoiseAboutALampInAGlobe) {
    const Scene scene = roomWithLamp({.hasShade = false, .globe = 0.1f});
    settings_.budget.mostSamplesPerPixel = 256;
    settings_.estimator.maxBounces = 6;
    const LitCells cells = findLitCells(packed(scene));
    const Film plain = pictureOf(scene, false, cells), aimed = pictureOf(scene, true, cells);
    EXPECT_LT(noiseOf(aimed), noiseOf(plain) / 2);
}

TEST_F(AimedBounces, HaveLessNoiseAboutALampInAShade) {
    const Scene scene = roomWithLamp({});
    const LitCells cells = findLitCells(packed(scene));
    settings_.budget.mostSamplesPerPixel = 256;
    const Film plain = pictureOf(scene, false, cells), aimed = pictureOf(scene, true, cells);
    EXPECT_LT(noiseOf(aimed), noiseOf(plain) / 1.5);
}

TEST_F(AimedBounces, HaveTheSameBytesHoweverTheWorkIsCut) {
    const Scene scene = roomWithLamp({.globe = 0.1f});
    settings_.budget.mostSamplesPerPixel = 8;
    settings_.estimator.branches = 4;
    expectTheSameBytesHoweverTheWorkIsCut(
        [&](const KernelTuning& tuning) { return pictureOf(scene, true, {}, tuning); });
}

} // namespace
} // namespace stromboli

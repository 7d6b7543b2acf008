// Every field of every structure that C++ and GLSL share arrives where it is meant to, bit for
// bit: through storage and texel buffers, as uniforms, push constants and storage buffers.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/rows.hpp"
#include "shaders/shared/scene_types.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/layout_storage.h"
#include "embedded/layout_texel.h"

#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <type_traits>

namespace stromboli::test {
namespace {

/// Fields of a structure as words, by name: what the compiler of C++ holds them to be.
class Words {
  public:
    void put(uint32_t word) { words_.push_back(word); }
    void put(float x) { put(std::bit_cast<uint32_t>(x)); }
    void put(const glm::vec3& v) { put(v.x), put(v.y), put(v.z); }
    void put(const glm::vec4& v) { put(v.x), put(v.y), put(v.z), put(v.w); }
    template <class... Fields>
    void structure(const std::string& name, const Fields&... fields) {
        const size_t first = words_.size();
        (put(fields), ...);
        while (names_.size() < words_.size())
            names_.push_back(name + " word " + std::to_string(names_.size() - first));
    }
    size_t size() const { return words_.size(); }
    uint32_t word(size_t i) const { return words_[i]; }
    const std::string& name(size_t i) const { return names_[i]; }

  private:
    std::vector<uint32_t> words_;
    std::vector<std::string> names_;
};

/// Distinct words for each use: plain counters, or the bits of NaNs (quiet and signalling, both
/// signs), infinities and denormals, which a detour through float arithmetic would change.
class Patterns {
  public:
    explicit Patterns(bool awkward) : awkward_(awkward) {}

    /// Three of a structure, every word distinct; index 1 is what the shader reads.
    template <class T>
    std::vector<T> several() {
        static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
        std::vector<T> result(3);
        for (T& value : result) {
            std::array<uint32_t, sizeof(T) / 4> words;
            for (uint32_t& word : words)
                word = next();
            std::memcpy(&value, words.data(), sizeof(T));
        }
        return result;
    }

  private:
    uint32_t next() {
        ++counter_;
        if (!awkward_) return 0x01000000u + counter_ * 0x00010203u;
        static constexpr uint32_t kBases[] = {0x7F800000, 0x7FC00000, 0xFF800000, 0xFFC00000,
                                              0x00000000, 0x80000000, 0x7F000000};
        return kBases[counter_ % 7] + counter_;
    }
    bool awkward_;
    uint32_t counter_ = 0;
};

/// A header and the most rows of parameters that a kind has.
using MaterialWords = std::array<Row, 9>;
using LightWords = std::array<Row, gpu::LIGHT_ROWS>;

struct LayoutCase {
    bool texelFetch;
    bool awkward;
};

class LayoutTest : public DeviceTest, public ::testing::WithParamInterface<LayoutCase> {
  protected:
    void fillScene(TestShader& shader, Patterns& patterns) {
        const auto records = patterns.several<Record>();
        const auto primitives = patterns.several<gpu::Primitive>();
        const auto materials = patterns.several<MaterialWords>();
        const auto lights = patterns.several<LightWords>();
        auto table = patterns.several<Row>();
        table.push_back(patterns.several<Row>()[0]); // the second row of node 0: expectTable()
        shader.set(BINDING_RECORDS, records);
        shader.set(BINDING_PRIMITIVES, primitives);
        shader.set(BINDING_MATERIALS, materials);
        shader.set(BINDING_LIGHTS, lights);
        shader.set(BINDING_LIGHT_TABLE, table);
        expectNode(asNode(records[1]));
        expectLeaf(asLeaf(records[2]));
        const auto placement = asPlacement(records[1]);
        expected_.structure("PlacementRecord", placement.root, placement.transform,
                            placement.placement, placement.kind, placement.toPrototype0,
                            placement.toPrototype1, placement.toPrototype2);
        const auto transform = std::bit_cast<gpu::TransformRecord>(records[2]);
        expected_.structure("TransformRecord", transform.toWorld0, transform.toWorld1,
                            transform.toWorld2, transform.reach, transform.unused0,
                            transform.unused1, transform.unused2);
        expected_.structure("Primitive", primitives[1].material, primitives[1].n0, primitives[1].n1,
                            primitives[1].n2);
        expectMaterial(materials[1]);
        expectLight(lights[1]);
        expectTable(table);
    }

    void expectNode(const gpu::NodeRecord& n) {
        expected_.structure("NodeRecord", n.originAndExponentX, n.originAndExponentY,
                            n.originAndExponentZ, n.firstChild, n.lowX0, n.lowX1, n.highX0,
                            n.highX1, n.lowY0, n.lowY1, n.highY0, n.highY1, n.lowZ0, n.lowZ1,
                            n.highZ0, n.highZ1);
    }

    /// Once as it is, then both of its primitives.
    void expectLeaf(const gpu::LeafRecord& l) {
        expected_.structure("LeafRecord", l.p0, l.primitive, l.p1, l.light0, l.p3, l.light1, l.p2,
                            l.homeOrRadius);
        const uint32_t isSphere = (l.primitive & gpu::RECORD_IS_SPHERE) != 0;
        const uint32_t primitive = l.primitive & gpu::RECORD_INDEX_MASK;
        expected_.structure("slot 0", l.p0, l.p1, l.p2, l.homeOrRadius, isSphere, primitive,
                            l.light0);
        expected_.structure("slot 1", l.p0, l.p2, l.p3, l.homeOrRadius, isSphere, primitive + 1,
                            l.light1);
    }

    /// The rows that follow the header, as the parameters of every recipe.
    void expectMaterial(const MaterialWords& m) {
        const auto header = std::bit_cast<gpu::MaterialHeader>(m[0]);
        expected_.structure("MaterialHeader", header.emission, header.closures);
        const auto stated = std::bit_cast<gpu::StatedParameters>(std::array{m[1], m[2], m[3]});
        const auto principled = std::bit_cast<gpu::PrincipledParameters>(
            std::array{m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]});
        const auto burley =
            std::bit_cast<gpu::BurleyParameters>(std::array{m[1], m[2], m[3], m[4]});
#define EXPECT_STATED(type, name, row, place, value)                                               \
    expected_.structure("StatedParameters::" #name, stated.name);
#define EXPECT_PRINCIPLED(type, name, row, place, value)                                           \
    expected_.structure("PrincipledParameters::" #name, principled.name);
#define EXPECT_BURLEY(type, name, row, place, value)                                               \
    expected_.structure("BurleyParameters::" #name, burley.name);
        STATED_PARAMETERS(EXPECT_STATED)
        PRINCIPLED_PARAMETERS(EXPECT_PRINCIPLED)
        BURLEY_PARAMETERS(EXPECT_BURLEY)
    }

    void expectLight(const LightWords& l) {
        const auto header = std::bit_cast<gpu::LightHeader>(l[0]);
        expected_.structure("LightHeader", header.color, header.kind);
        // A structure of fewer rows has the first ones.
        const auto behind = std::bit_cast<std::array<uint32_t, 12>>(std::array{l[1], l[2], l[3]});
#define EXPECT_FIELD(type, name, row, place) expected_.structure("light's " #name, light.name);
#define EXPECT_LIGHT(Structure, function, fields, met, sample)                                     \
    {                                                                                              \
        gpu::Structure light;                                                                      \
        std::memcpy(&light, behind.data(), sizeof(light));                                         \
        fields(EXPECT_FIELD)                                                                       \
    }
        LIGHT_STRUCTURES(EXPECT_LIGHT)
    }

    /// Row 1 as an entry; the frame's count of lights is 1 there, so that column 0 is row 1 too,
    /// and the rows of node 0 are 1 and 3.
    void expectTable(const std::vector<Row>& table) {
        const auto entry = std::bit_cast<gpu::LightEntry>(table[1]);
        expected_.structure("LightEntry", entry.light, entry.trail, entry.probability, entry.group);
        const auto column = std::bit_cast<gpu::AliasColumn>(table[1]);
        expected_.structure("AliasColumn", column.threshold, column.alias, column.unused0,
                            column.unused1);
        const std::array<Row, 2> two = {table[1], table[3]};
        const auto node = std::bit_cast<gpu::LightNode>(two);
        expected_.structure("LightNode", node.center, node.radiusAndPower, node.axis,
                            node.cosSpread, node.flags, node.unused);
    }

    void fillFrame(TestShader& shader, Patterns& patterns) {
        gpu::Frame f = patterns.several<gpu::Frame>()[1];
        f.lightCount = 1; // where the table's nodes and columns begin: expectTable()
        shader.setOne(BINDING_FRAME, f);
        expected_.structure(
            "Frame", f.cameraPosition, f.width, f.cameraRight, f.height, f.cameraUp, f.firstSample,
            f.cameraBack, f.keepsValue, f.nearDistance, f.farDistance, f.gapWidth, f.seed,
            f.minBounce, f.maxBounces, f.terminationProbability, f.lightCount, f.areaLights,
            f.hemisphereSamples, f.lightSamples, f.branches, f.ambientLight, f.lightsInGroup0,
            f.lightsInGroup1, f.lightsInGroup2, f.lensRadius, f.focusDistance, f.cameraMedium,
            f.portalShare, f.litCells, f.leastFall, f.unused0, f.unused1, f.shadowAcross,
            f.shadowAlong, f.shadowTowards, f.shadowMap);
        for (const glm::vec4& row : f.portals)
            expected_.structure("Frame, portals", row);
        for (const glm::vec4& row : f.occluders)
            expected_.structure("Frame, occluders", row);
    }

    void fillWork(TestShader& shader, Patterns& patterns, const gpu::Dispatch& d) {
        expected_.structure("Dispatch", 1u, d.segmentBase, d.softIterations, d.hardIterations,
                            d.laneCount, d.groupsPerThread, d.sharedIterations, d.beginsNoSample,
                            d.rayQueue, d.framePlace, d.unused0, d.unused1);
        const auto items = patterns.several<gpu::WorkItem>();
        shader.set(BINDING_WORK_ITEMS, items);
        expected_.structure("WorkItem", items[1].pixel, items[1].target, items[1].column,
                            items[1].row);
        states_ = patterns.several<gpu::PixelState>();
        shader.set(BINDING_PIXELS, states_);
        const gpu::PixelState& s = states_[1];
        expected_.structure("PixelState", s.sum, s.count, s.sumError, s.rejected, s.m2,
                            s.firstRejected, s.m2Error, s.samplesBefore);
        const gpu::DispatchStatus status = patterns.several<gpu::DispatchStatus>()[0];
        shader.setOne(BINDING_STATUS, status);
        expected_.structure("DispatchStatus", status.unfinishedItems, status.overflowedItems,
                            status.rays, status.samples, status.nextItem, status.busySteps,
                            status.allSteps, status.iterations);
    }

    Words expected_;
    std::vector<gpu::PixelState> states_;
};

/// Compares memory: NaNs are not equal to themselves.
template <class T>
bool sameBits(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

TEST_P(LayoutTest, EveryFieldArrives) {
    ShaderOptions options;
    options.texelFetch = GetParam().texelFetch;
    TestShader shader(options.texelFetch ? std::span<const uint32_t>(layout_texel)
                                         : std::span<const uint32_t>(layout_storage),
                      options);
    Patterns patterns(GetParam().awkward);
    gpu::Dispatch constants = patterns.several<gpu::Dispatch>()[1];
    fillScene(shader, patterns);
    fillFrame(shader, patterns);
    fillWork(shader, patterns, constants);
    shader.set(kAnswerBinding, std::vector<uint32_t>(expected_.size() + 1, 0xDEADBEEF));
    shader.run(1, constants);

    const auto found = shader.get<uint32_t>(kAnswerBinding, expected_.size() + 1);
    for (size_t i = 0; i < expected_.size(); ++i)
        EXPECT_EQ(found[i], expected_.word(i)) << expected_.name(i);
    EXPECT_EQ(found.back(), 0xDEADBEEF) << "the shader writes more fields than C++ has";
    EXPECT_TRUE(sameBits(shader.get<gpu::PixelState>(BINDING_PIXELS, 3)[2], states_[1]));
}

INSTANTIATE_TEST_SUITE_P(Fetch, LayoutTest,
                         ::testing::Values(LayoutCase{false, false}, LayoutCase{false, true},
                                           LayoutCase{true, false}, LayoutCase{true, true}),
                         [](const auto& layout) {
                             return std::string(layout.param.texelFetch ? "Texel" : "Storage") +
                                    (layout.param.awkward ? "WithNans" : "");
                         });

/// The expectation above names fields in the order of declaration; nothing may be left out. What
/// comes from tables is complete.
TEST(LayoutSizes, NoFieldIsForgotten) {
    const size_t bytes =
        sizeof(gpu::NodeRecord) + sizeof(gpu::LeafRecord) + sizeof(gpu::PlacementRecord) +
        sizeof(gpu::TransformRecord) + sizeof(gpu::Primitive) + sizeof(gpu::MaterialHeader) +
        sizeof(gpu::LightHeader) + sizeof(gpu::LightEntry) + sizeof(gpu::AliasColumn) +
        sizeof(gpu::LightNode) + sizeof(gpu::Frame) + sizeof(gpu::Dispatch) +
        sizeof(gpu::WorkItem) + sizeof(gpu::PixelState) + sizeof(gpu::DispatchStatus);
    EXPECT_EQ(bytes / 4, 16 + 16 + 16 + 16 + 4 + 4 + 4 + (4 + 4 + 8) + 308 + 12 + 4 + 16 + 8u);
}

} // namespace
} // namespace stromboli::test

// Accessors and primitives.

#include "tests/scene/gltf/gltf_text.hpp"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// Five points around a corner.
const std::vector<float> kFive = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};

/// Shows five points as the primitive says.
GltfText fivePoints(const std::string& primitive) {
    GltfText g;
    g.addTriangle();
    const size_t positions = g.addAccessor<float>(kFive, "VEC3");
    g.arrays["meshes"][0] = fmt::format(
        R"({{"primitives": [{{"attributes": {{"POSITION": {}}}{}}}]}})", positions, primitive);
    return g;
}

/// The corners of each triangle as x + 10 y.
std::vector<std::vector<int>> corners(const Scene& scene) {
    std::vector<std::vector<int>> found;
    for (const Triangle& t : scene.triangles) {
        found.emplace_back();
        for (const uint32_t c : t.corner)
            found.back().push_back(int(scene.positions[c].x + 10 * scene.positions[c].y));
    }
    return found;
}

TEST(GltfPrimitives, Triangles) {
    EXPECT_THAT(corners(load(fivePoints(""))), ElementsAre(ElementsAre(0, 1, 10)));
    EXPECT_THAT(load(fivePoints("")).report.forgiven,
                Contains(HasSubstr("5 corners are no whole triangles")));
}

TEST(GltfPrimitives, Strips) {
    EXPECT_THAT(
        corners(load(fivePoints(R"(, "mode": 5)"))),
        ElementsAre(ElementsAre(0, 1, 10), ElementsAre(1, 11, 10), ElementsAre(10, 11, 20)));
}

TEST(GltfPrimitives, Fans) {
    GltfText g = fivePoints("");
    const size_t indices = g.addAccessor<uint8_t>({0, 1, 3, 2}, "SCALAR");
    g.arrays["meshes"][0].insert(g.arrays["meshes"][0].size() - 3,
                                 fmt::format(R"(, "mode": 6, "indices": {})", indices));
    EXPECT_THAT(corners(load(g)), ElementsAre(ElementsAre(1, 11, 0), ElementsAre(11, 10, 0)));
}

TEST(GltfPrimitives, PointsAndLinesAreReported) {
    const Scene scene = load(fivePoints(R"(, "mode": 1)"));
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_THAT(scene.report.ignored,
                Contains("1 primitives of points or lines: only triangles are shown"));
    EXPECT_EQ(problem(fivePoints(R"(, "mode": 7)")),
              "<meshes[0].primitives[0].mode>: is 7, expected 0 to 6");
}

template <class T>
void expectIndices() {
    GltfText g = fivePoints("");
    const size_t indices = g.addAccessor<T>({4, 3, 1}, "SCALAR");
    g.arrays["meshes"][0].insert(g.arrays["meshes"][0].size() - 3,
                                 fmt::format(R"(, "indices": {})", indices));
    EXPECT_THAT(corners(load(g)), ElementsAre(ElementsAre(20, 11, 1)));
}

TEST(GltfPrimitives, IndicesOfAllTypes) {
    expectIndices<uint8_t>();
    expectIndices<uint16_t>();
    expectIndices<uint32_t>();
}

TEST(GltfPrimitives, IndicesInRange) {
    GltfText g;
    const size_t indices = g.addAccessor<uint8_t>({0, 1, 3}, "SCALAR");
    g.addTriangle(fmt::format(R"(, "indices": {})", indices));
    EXPECT_EQ(problem(g),
              "<meshes[0].primitives[0].indices>: has the index 3, but there are 3 vertices");
}

TEST(GltfAccessors, Interleaved) {
    GltfText g;
    g.addTriangle();
    std::vector<float> mixed; // a position and a normal, and four bytes between
    for (size_t i = 0; i < 3; ++i) {
        mixed.insert(mixed.end(), kFive.begin() + ptrdiff_t(3 * i),
                     kFive.begin() + ptrdiff_t(3 * i + 3));
        mixed.insert(mixed.end(), {-1, 1, 0, 1});
    }
    const size_t view = g.addView({reinterpret_cast<const char*>(mixed.data()), mixed.size() * 4},
                                  R"(, "byteStride": 28)");
    const auto accessor = [&](int offset) {
        return g.addTo("accessors", fmt::format(R"("bufferView": {}, "byteOffset": {}, "count": 3,
            "componentType": 5126, "type": "VEC3")",
                                                view, offset));
    };
    const size_t positions = accessor(0), normals = accessor(16);
    g.arrays["meshes"][0] =
        fmt::format(R"({{"primitives": [{{"attributes": {{"POSITION": {}, "NORMAL": {}}}}}]}})",
                    positions, normals);
    const Scene scene = load(g);
    EXPECT_THAT(corners(scene), ElementsAre(ElementsAre(0, 1, 10)));
    ASSERT_EQ(scene.normals.size(), 3u);
    EXPECT_LT(glm::distance(scene.normals[0], glm::normalize(glm::vec3(1, 0, 1))), 1e-6);
}

TEST(GltfAccessors, NormalisedIntegers) {
    GltfText g;
    const size_t uv =
        g.addAccessor<uint16_t>({0, 0, 65535, 0, 0, 13107}, "VEC2", R"(, "normalized": true)");
    const size_t color = g.addAccessor<uint8_t>({255, 51, 0, 255, 0, 0, 0, 0, 0, 0, 0, 102}, "VEC4",
                                                R"(, "normalized": true)");
    const size_t positions = g.addAccessor<int8_t>({0, 0, 0, 0, 127, -128, 0, 0, -127, 64, 0, 0},
                                                   "VEC4", R"(, "normalized": true)");
    // Positions of three bytes in steps of four (KHR_mesh_quantization).
    g.arrays["accessors"][positions].replace(g.arrays["accessors"][positions].find("VEC4"), 4,
                                             "VEC3");
    g.arrays["bufferViews"][positions].insert(1, R"("byteStride": 4, )");
    g.addTriangle(R"(, "material": 0)",
                  fmt::format(R"(, "TEXCOORD_0": {}, "COLOR_0": {})", uv, color));
    g.arrays["meshes"][0] = fmt::format(
        R"({{"primitives": [{{"attributes": {{"POSITION": {}, "TEXCOORD_0": {}, "COLOR_0": {}}}}}]}})",
        positions, uv, color);
    const Scene scene = load(g);
    const Triangle& t = scene.triangles.at(0);
    EXPECT_EQ(scene.positions[t.corner[1]], glm::vec3(1, -1, 0)); // -128 and -127 are both -1
    EXPECT_EQ(scene.positions[t.corner[2]], glm::vec3(-1, 64 / 127.0f, 0));
    const VertexAttributes& a = scene.attributes.at(scene.attributeCorners.at(0)[0]);
    EXPECT_EQ(a.color, glm::vec4(1, 0.2f, 0, 1));
    const VertexAttributes& c = scene.attributes.at(scene.attributeCorners.at(0)[2]);
    EXPECT_EQ(c.uv[0], glm::vec2(0, 0.2f));
    EXPECT_EQ(c.color.w, 0.4f);
}

TEST(GltfAccessors, Sparse) {
    GltfText g;
    g.addTriangle();
    const size_t places = g.addView(std::string_view("\x01\x00\x02\x00", 4));
    const float moved[] = {5, 0, 0, 0, 6, 0};
    const size_t values = g.addView({reinterpret_cast<const char*>(moved), sizeof moved});
    const std::string sparse = fmt::format(
        R"(, "sparse": {{"count": 2, "indices": {{"bufferView": {}, "componentType": 5123}},
        "values": {{"bufferView": {}}}}})",
        places, values);
    g.arrays["accessors"][0].insert(g.arrays["accessors"][0].size() - 1, sparse);
    EXPECT_THAT(corners(load(g)), ElementsAre(ElementsAre(0, 5, 60)));
    // Sparse numbers upon zeros.
    g.arrays["accessors"][0] =
        R"({"count": 3, "componentType": 5126, "type": "VEC3")" + sparse + "}";
    EXPECT_THAT(corners(load(g)), ElementsAre(ElementsAre(0, 5, 60)));
    g.arrays["accessors"][0] =
        R"({"count": 2, "componentType": 5126, "type": "VEC3")" + sparse + "}";
    EXPECT_THAT(problem(g), HasSubstr("<accessors[0].sparse.indices>: names element 2 of 2"));
}

TEST(GltfAccessors, AbsurdCounts) {
    GltfText g;
    g.addTriangle();
    std::string& accessor = g.arrays["accessors"][0];
    accessor.replace(accessor.find("\"count\": 3"), 10, "\"count\": 3000000000");
    EXPECT_EQ(problem(g), "<accessors[0]>: 3000000000 elements of 12 bytes, 12 bytes apart, from "
                          "byte 0 on, are beyond the 36 bytes of bufferViews[0]");
    accessor.replace(accessor.find("3000000000"), 10, "9007199254740993e99");
    EXPECT_THAT(problem(g), HasSubstr("<accessors[0].count>: is "));
    accessor = R"({"count": 9000000000, "componentType": 5126, "type": "VEC3"})";
    EXPECT_EQ(problem(g),
              "<accessors[0].count>: is 9000000000, without a 'bufferView' that holds them");
    accessor =
        R"({"bufferView": 0, "count": 2, "byteOffset": 16, "componentType": 5126, "type": "VEC3"})";
    EXPECT_THAT(problem(g), HasSubstr("from byte 16 on, are beyond the 36 bytes"));
    accessor = R"({"bufferView": 0, "count": -3, "componentType": 5126, "type": "VEC3"})";
    EXPECT_EQ(problem(g), "<accessors[0].count>: is -3, expected a whole number of at least 0");
}

TEST(GltfAccessors, OfTheRightType) {
    GltfText g;
    g.addTriangle();
    std::string& accessor = g.arrays["accessors"][0];
    accessor = R"({"bufferView": 0, "count": 3, "componentType": 5126, "type": "VEC2"})";
    EXPECT_EQ(problem(g), "<accessors[0].type>: is 'VEC2': elements have 2 numbers, expected 3");
    accessor = R"({"bufferView": 0, "count": 3, "componentType": 5124, "type": "VEC3"})";
    EXPECT_EQ(problem(g),
              "<accessors[0].componentType>: is 5124, expected 5120 to 5123, 5125 or 5126");
}

/// The triangle's positions, packed; the view's own buffer, the second, is a stand-in that is never
/// read.
TEST(GltfCompression, Meshopt) {
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(3, 12));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), points.data(), 3, 12));
    const auto file = [&](const std::string& count) {
        GltfText g;
        g.addTriangle();
        const size_t view =
            g.addView({reinterpret_cast<const char*>(packed.data()), packed.size()});
        const std::string source = g.arrays["bufferViews"][view];
        g.arrays["bufferViews"][0] = fmt::format(
            R"({{"buffer": 1, "byteLength": 36, "byteStride": 12, "extensions":
            {{"EXT_meshopt_compression": {{{}, "byteStride": 12, "mode": "ATTRIBUTES", "count": {}}}}}}})",
            source.substr(1, source.size() - 2), count);
        return g.binary();
    };
    EXPECT_THAT(corners(loadGltfBytes(file("3"))), ElementsAre(ElementsAre(0, 1, 10)));
    EXPECT_THAT(gltfProblem(file("4000000000")), HasSubstr("packed bytes cannot hold"));
    packed[0] = '?'; // says which codec it is
    EXPECT_THAT(gltfProblem(file("3")),
                HasSubstr("EXT_meshopt_compression>: the packed data are damaged"));
}

TEST(GltfCompression, Draco) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(1);
    const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const float points[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(0), points[0], points[1], points[2]);
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    GltfText g;
    g.addTriangle();
    const size_t view = g.addView({buffer.data(), buffer.size()});
    const std::string primitive =
        R"({{"primitives": [{{"attributes": {{"POSITION": 0}}, "extensions":
        {{"KHR_draco_mesh_compression": {{"bufferView": {}, "attributes": {{"POSITION": {}}}}}}}}}]}})";
    g.arrays["accessors"][0] = R"({"count": 3, "componentType": 5126, "type": "VEC3"})";
    g.arrays["meshes"][0] = fmt::format(fmt::runtime(primitive), view, 0);
    const Scene scene = load(g);
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.bounds().hi, glm::vec3(1, 1, 0));
    // Morph targets lie beside what is packed, in its order, with the names of its attributes.
    const size_t moved = g.addAccessor<float>({0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3");
    g.arrays["meshes"][0] = fmt::format(
        R"({{"weights": [0.5], "primitives": [{{"attributes": {{"POSITION": 0}}, "targets": [{{"POSITION": {}}}],
        "extensions": {{"KHR_draco_mesh_compression": {{"bufferView": {}, "attributes": {{"POSITION": 0}}}}}}}}]}})",
        moved, view);
    EXPECT_EQ(load(g).bounds().lo, glm::vec3(0, 0, 1));
    EXPECT_EQ(load(g).bounds().hi, glm::vec3(1, 1, 1));
    g.arrays["meshes"][0] = fmt::format(fmt::runtime(primitive), view, 77);
    EXPECT_THAT(problem(g), HasSubstr("names attribute 77, which is not there"));
    g.arrays["meshes"][0] = fmt::format(fmt::runtime(primitive), 0, 0);
    EXPECT_THAT(problem(g), HasSubstr("the packed mesh is damaged"));
}

} // namespace
} // namespace stromboli::test

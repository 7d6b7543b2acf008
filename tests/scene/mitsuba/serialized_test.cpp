// Mitsuba's own format of meshes, from bytes made here.

#include "scene/mitsuba/serialized.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <zlib.h>

#include <functional>

namespace stromboli::test {
namespace {

using mitsuba::FileMesh;
using testing::HasSubstr;

template <class T>
std::string bytesOf(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string packed(const std::string& bytes) {
    std::string out(compressBound(uLong(bytes.size())), '\0');
    uLongf size = uLongf(out.size());
    compress(reinterpret_cast<Bytef*>(out.data()), &size,
             reinterpret_cast<const Bytef*>(bytes.data()), uLong(bytes.size()));
    out.resize(size);
    return out;
}

/// A triangle, x shifted, of numbers of type T.
template <class T>
std::string triangle(uint32_t flags, uint16_t version, T shift, uint32_t lastIndex = 2) {
    std::string inside = bytesOf(flags);
    if (version == 4) inside += std::string("name") + '\0';
    inside += bytesOf(uint64_t(3)) + bytesOf(uint64_t(1));
    for (const T x : {T(0) + shift, T(0), T(0), T(1) + shift, T(0), T(0), T(0) + shift, T(1), T(0)})
        inside += bytesOf(x);
    if (flags & 0x1)
        for (int i = 0; i < 3; ++i)
            inside += bytesOf(T(0)) + bytesOf(T(0)) + bytesOf(T(2));
    if (flags & 0x2)
        for (int i = 0; i < 3; ++i)
            inside += bytesOf(T(0.25)) + bytesOf(T(0.25));
    if (flags & 0x8)
        for (int i = 0; i < 9; ++i)
            inside += bytesOf(T(0.5));
    for (const uint32_t i : {0u, 1u, lastIndex})
        inside += bytesOf(i);
    return bytesOf(uint16_t(0x041C)) + bytesOf(version) + packed(inside);
}

/// A file of these meshes.
std::string fileOf(const std::vector<std::string>& meshes, uint16_t version) {
    std::string file, table;
    for (const std::string& mesh : meshes) {
        table += version == 4 ? bytesOf(uint64_t(file.size())) : bytesOf(uint32_t(file.size()));
        file += mesh;
    }
    return file + table + bytesOf(uint32_t(meshes.size()));
}

/// Read without a word.
FileMesh serializedMesh(const std::string& bytes, uint64_t number = 0) {
    build::Report report(true);
    return mitsuba::serializedMesh(bytes, "file", number, report);
}

TEST(SerializedMeshes, HaveEveryAttributeInEitherPrecision) {
    for (const uint16_t version : {uint16_t(3), uint16_t(4)})
        for (const bool isDouble : {false, true}) {
            const uint32_t flags = 0xB | (isDouble ? 0x2000u : 0x1000u);
            const std::string one =
                isDouble ? triangle<double>(flags, version, 5) : triangle<float>(flags, version, 5);
            const FileMesh found = serializedMesh(fileOf({one}, version), 0);
            ASSERT_EQ(found.mesh.parts.at(0).size(), 1u);
            EXPECT_EQ(found.mesh.positions.at(1), glm::dvec3(6, 0, 0));
            EXPECT_EQ(found.mesh.normals.at(2), glm::dvec3(0, 0, 2));
            EXPECT_EQ(found.mesh.attributes.at(0).uv[0], glm::vec2(0.25f, 0.75f));
            EXPECT_EQ(found.mesh.attributes.at(0).color, glm::vec4(0.5f, 0.5f, 0.5f, 1));
            EXPECT_TRUE(found.hasCoordinates && found.hasColors);
            EXPECT_EQ(found.mesh.parts[0][0][2].normal, 2u);
        }
}

TEST(SerializedMeshes, AreNumbered) {
    for (const uint16_t version : {uint16_t(3), uint16_t(4)}) {
        const std::string file = fileOf(
            {triangle<float>(0x1000, version, 0), triangle<float>(0x1000, version, 7)}, version);
        EXPECT_EQ(serializedMesh(file, 0).mesh.positions.at(0).x, 0);
        const FileMesh second = serializedMesh(file, 1);
        EXPECT_EQ(second.mesh.positions.at(0).x, 7);
        EXPECT_TRUE(second.mesh.attributes.empty());
        EXPECT_EQ(second.mesh.parts[0][0][1].attributes, kNoAttributes);
    }
}

/// Mitsuba looks at the flag of double precision alone.
TEST(SerializedMeshes, WithoutAPrecisionAreSingle) {
    const FileMesh found = serializedMesh(fileOf({triangle<float>(0x000B, 3, 5)}, 3));
    EXPECT_EQ(found.mesh.positions.at(1), glm::dvec3(6, 0, 0));
    const FileMesh both = serializedMesh(fileOf({triangle<double>(0x300B, 4, 5)}, 4));
    EXPECT_EQ(both.mesh.positions.at(1), glm::dvec3(6, 0, 0));
}

TEST(SerializedMeshes, OfFaceNormalsAreFlat) {
    const FileMesh found = serializedMesh(fileOf({triangle<float>(0x1011, 4, 0)}, 4), 0);
    EXPECT_TRUE(found.mesh.isFlat);
    EXPECT_TRUE(found.mesh.normals.empty());
}

std::string problemOfBytes(const std::string& bytes, uint64_t number = 0) {
    try {
        serializedMesh(bytes, number);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(SerializedMeshes, WrongOnesSayWhy) {
    const std::string good = fileOf({triangle<float>(0x1000, 4, 0)}, 4);
    EXPECT_THAT(problemOfBytes("short"), HasSubstr("is too short"));
    EXPECT_THAT(problemOfBytes("PK" + good.substr(2)), HasSubstr("expected 0x041c"));
    EXPECT_THAT(problemOfBytes(good.substr(0, 2) + bytesOf(uint16_t(9)) + good.substr(4)),
                HasSubstr("is of version 9, expected 3 or 4"));
    EXPECT_THAT(problemOfBytes(good, 1), HasSubstr("has no mesh with the number 1"));
    EXPECT_THAT(problemOfBytes(good.substr(0, good.size() - 4) + bytesOf(~0u)),
                HasSubstr("has no table"));
    EXPECT_THAT(problemOfBytes(fileOf({triangle<float>(0x1000, 4, 0, 3)}, 4)),
                HasSubstr("triangle 0 names vertex 3, but there are 3"));
    const std::string huge =
        bytesOf(0x1000u) + '\0' + bytesOf(uint64_t(1) << 31) + bytesOf(uint64_t(1));
    EXPECT_THAT(problemOfBytes(
                    fileOf({bytesOf(uint16_t(0x041C)) + bytesOf(uint16_t(4)) + packed(huge)}, 4)),
                HasSubstr("more than its bytes can hold"));
    const std::string cut =
        bytesOf(0x1000u) + '\0' + bytesOf(uint64_t(3)) + bytesOf(uint64_t(1)) + bytesOf(1.0f);
    EXPECT_THAT(
        problemOfBytes(fileOf({bytesOf(uint16_t(0x041C)) + bytesOf(uint16_t(4)) + packed(cut)}, 4)),
        HasSubstr("ends within a mesh"));
}

/// No byte makes the reader do anything but read or refuse.
TEST(SerializedMeshes, AnyByteMayBeWrong) {
    const std::string good = fileOf({triangle<float>(0x100B, 4, 0)}, 4);
    for (size_t i = 0; i < good.size(); ++i)
        for (const int bit : {0, 3, 7}) {
            std::string bad = good;
            bad[i] = char(bad[i] ^ 1 << bit);
            problemOfBytes(bad);
        }
}

TEST(SerializedMeshes, AreShapes) {
    const std::string name =
        writeFile("two.serialized",
                  fileOf({triangle<float>(0x1000, 4, 0), triangle<float>(0x1000, 4, 7)}, 4))
            .filename()
            .string();
    const Scene scene =
        loadInside("<shape type=\"serialized\"><string name=\"filename\" value=\"" + name +
                   "\"/><integer name=\"shape_index\" value=\"1\"/></shape>");
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.positions.at(scene.triangles[0].corner[0]).x, 7);
}

} // namespace
} // namespace stromboli::test

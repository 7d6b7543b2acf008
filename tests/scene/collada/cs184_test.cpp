// The CS184 renderer's conventions of reading a file (docs/guide/cs184.md).

#include "tests/scene/collada/document_text.hpp"

#include <map>

namespace stromboli::test {
namespace {

Scene loadMesh(const std::string& positions, int count, int triangles, const std::string& p,
               const std::string& transforms = "", const std::string& asset = "") {
    DocumentText document;
    document.asset = asset;
    document.libraries = meshLibrary(
        positions, count,
        fmt::format("<triangles count=\"{}\">{}<p>{}</p></triangles>", triangles, kVertexInput, p));
    document.nodes = meshNode(transforms);
    return load(document, true);
}

/// The normal stored for each position.
std::map<uint32_t, glm::dvec3> vertexNormals(const Scene& scene) {
    std::map<uint32_t, glm::dvec3> normals;
    for (const Triangle& t : scene.triangles)
        for (int i = 0; i < 3; ++i)
            normals[t.corner[i]] = scene.normals.at(t.normals[i]);
    return normals;
}

TEST(Cs184, OpenPlaneQuadsHaveReversedNormals) {
    for (const char* p : {"0 1 2 0 2 3", "0 1 2 3 0 2", "3 1 2 0 1 3"}) {
        const Scene scene = loadMesh("1 1.5 -1 -1 1.5 -1 -1 1.5 1 1 1.5 1", 12, 2, p);
        const glm::dvec3 winding = scene.geometricNormal(scene.triangles[0]);
        const auto normals = vertexNormals(scene);
        ASSERT_EQ(normals.size(), 4u);
        for (const auto& [position, normal] : normals)
            expectNear(normal, -winding, 1e-7);
    }
}

TEST(Cs184, ClosedMeshesHaveAreaWeightedNormals) {
    // A tetrahedron with three right angles at vertex 0, wound outwards.
    const Scene scene = loadMesh("0 0 0 1 0 0 0 2 0 0 0 3", 12, 4, "0 2 1 0 1 3 0 3 2 1 2 3",
                                 "<scale>2 2 2</scale>");
    EXPECT_EQ(scene.normals.size(), 4u);
    const auto normals = vertexNormals(scene);
    // Cross products: (0, 0, -2), (0, -3, 0), (-6, 0, 0), (6, 3, 2).
    expectNear(normals.at(scene.triangles[0].corner[0]), glm::normalize(glm::dvec3(-6, -3, -2)));
    expectNear(normals.at(scene.triangles[1].corner[1]), glm::normalize(glm::dvec3(6, 0, 0)));
}

TEST(Cs184, FileNormalsAndMirroringDoNotTurnTriangles) {
    DocumentText document;
    document.libraries =
        meshLibrary("0 0 0 1 0 0 0 1 0", 9,
                    fmt::format("<triangles count=\"1\">{}{}<p>0 0 1 0 2 0</p></triangles>",
                                kVertexInput, kNormalInput),
                    floats("nrm", "0 0 -1", 3));
    document.nodes = meshNode();
    const Scene plain = load(document, true);
    EXPECT_EQ(plain.geometricNormal(plain.triangles[0]), glm::vec3(0, 0, 1));
    document.nodes = meshNode("<scale>-1 1 1</scale>");
    const Scene mirrored = load(document, true);
    EXPECT_EQ(mirrored.geometricNormal(mirrored.triangles[0]), glm::vec3(0, 0, -1));
}

TEST(Cs184, TheUnitIsIgnored) {
    const Scene scene = loadMesh("0 0 0 1 0 0 0 1 0", 9, 1, "0 1 2", "",
                                 "<unit meter=\"0.01\"/><up_axis>Z_UP</up_axis>");
    expectNear(scene.bounds().extent(), {1, 0, 1});
}

TEST(Cs184, TheFirstMaterialCountsForAll) {
    DocumentText document;
    document.libraries =
        "<library_effects><effect id=\"e\"><extra><technique profile=\"CGL\"><emission>"
        "<radiance>1 2 3</radiance></emission></technique></extra></effect></library_effects>"
        "<library_materials><material id=\"m\"><instance_effect url=\"#e\"/></material>"
        "</library_materials>" +
        triangleLibrary();
    document.nodes = "<node><instance_geometry url=\"#mesh\"><bind_material><technique_common>"
                     "<instance_material symbol=\"other\" target=\"#m\"/></technique_common>"
                     "</bind_material></instance_geometry></node>";
    for (bool cs184 : {true, false}) {
        const Scene scene = load(document, cs184);
        EXPECT_EQ(scene.materials[scene.triangles[0].material].emits(), cs184);
    }
}

} // namespace
} // namespace stromboli::test

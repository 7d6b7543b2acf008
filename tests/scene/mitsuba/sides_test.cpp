// Which side of a surface is its front, and what its back looks like.

#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

#include <vector>

namespace stromboli::test {
namespace {

const char* const kMirrored = "<transform name=\"to_world\"><scale x=\"-1\"/></transform>";
const char* const kFlipped = "<boolean name=\"flip_normals\" value=\"true\"/>";

std::string shapeOf(const std::string& type, const std::string& inside) {
    return fmt::format("<shape type=\"{}\">{}</shape>", type, inside);
}

/// A triangle whose front is z, without and with normals.
std::string triangleFile(bool hasNormals) {
    const std::string name = hasNormals ? "sides_n.obj" : "sides.obj";
    writeFile(name, hasNormals ? "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n"
                               : "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    return "<string name=\"filename\" value=\"" + name + "\"/>";
}

double frontAlongZ(const Scene& scene) {
    return double(scene.geometricNormal(scene.triangles.at(0)).z);
}

/// In Mitsuba 3 the corners of a mirrored mesh go round the other way. Normals of a file are
/// mirrored with it, and the rest of the shapes keep their front.
TEST(MitsubaSides, MirroredMeshesAreInsideOut) {
    const auto front = [](const std::string& type, const std::string& inside) {
        return frontAlongZ(loadInside(shapeOf(type, inside)));
    };
    EXPECT_EQ(front("obj", triangleFile(false)), 1);
    EXPECT_EQ(front("obj", triangleFile(false) + kMirrored), -1);
    EXPECT_EQ(front("obj", triangleFile(false) + kMirrored + kFlipped), 1);
    EXPECT_EQ(front("obj", triangleFile(true) + kMirrored), 1);
    EXPECT_EQ(front("obj", triangleFile(true) + kMirrored +
                               "<boolean name=\"face_normals\" value=\"true\"/>"),
              -1);
    EXPECT_EQ(front("rectangle", kMirrored), 1);
    const std::string old = "<transform name=\"toWorld\"><scale x=\"-1\"/></transform>";
    EXPECT_EQ(frontAlongZ(loadOld(shapeOf("obj", triangleFile(false) + old))), 1);
}

TEST(MitsubaSides, MirroredSpheresAreInsideOut) {
    EXPECT_EQ(loadInside(shapeOf("sphere", "")).spheres.size(), 1u);
    const Scene inward = loadInside(shapeOf("sphere", kMirrored));
    ASSERT_FALSE(inward.triangles.empty());
    for (const Triangle& t : inward.triangles)
        ASSERT_LT(glm::dot(inward.geometricNormal(t), inward.positions[t.corner[0]]), 0);
    EXPECT_EQ(loadInside(shapeOf("sphere", std::string(kMirrored) + kFlipped)).spheres.size(), 1u);
}

/// Mitsuba finds the bitangent as normal x tangent, mirrored or not.
TEST(MitsubaSides, FramesOfNormalMapsAreRightHanded) {
    const std::string normals = "<bsdf type=\"normalmap\"><texture name=\"normalmap\" "
                                "type=\"checkerboard\"/><bsdf type=\"diffuse\"/></bsdf>";
    for (const std::string transform : {"", kMirrored}) {
        const Scene scene = loadInside(rectangleOf(normals + transform));
        ASSERT_FALSE(scene.attributes.empty());
        for (const VertexAttributes& a : scene.attributes)
            EXPECT_EQ(a.tangent, glm::vec4(transform.empty() ? 1 : -1, 0, 0, 1));
    }
}

/// The scales of the reliefs that a surface and its back have, by turns: where it has no other
/// material behind, its own, which may be seen in a mirror.
std::vector<float> reliefsOf(const std::string& bsdf) {
    const Scene scene = loadInside(rectangleOf(bsdf));
    EXPECT_TRUE(scene.report.forgiven.empty());
    std::vector<float> scales;
    uint32_t number = scene.triangles.at(0).material;
    for (int side = 0; side < 2 && number != kNoMaterial; ++side) {
        const Material& m = scene.materials.at(number);
        for (const TextureUse& use : m.textures)
            if (use.slot == TextureSlot::Normal || use.slot == TextureSlot::Height) {
                scales.push_back(use.scale);
                if (m.mirrorsReliefBehind) scales.push_back(-use.scale);
            }
        EXPECT_EQ(m.otherPlace == OtherPlace::Behind, m.other != kNoMaterial);
        number = m.other;
    }
    return scales;
}

/// Mitsuba turns directions behind to the front by their cosine alone, so that what stands out does
/// so on both sides.
TEST(MitsubaSides, ReliefsAreMirroredBehind) {
    using testing::ElementsAre;
    const std::string board = "<texture type=\"checkerboard\"/>";
    const std::string bumps = "<bsdf type=\"bumpmap\"><float name=\"scale\" value=\"0.5\"/>" +
                              board + "<bsdf type=\"plastic\"/></bsdf>";
    const std::string normals = "<bsdf type=\"normalmap\"><texture name=\"normalmap\" "
                                "type=\"checkerboard\"/><bsdf type=\"diffuse\"/></bsdf>";
    const auto twoSided = [](const std::string& inside) {
        return "<bsdf type=\"twosided\">" + inside + "</bsdf>";
    };
    EXPECT_THAT(reliefsOf(bumps), ElementsAre(0.5f));
    EXPECT_THAT(reliefsOf(twoSided(bumps)), ElementsAre(0.5f, -0.5f));
    EXPECT_THAT(reliefsOf(twoSided(normals)), ElementsAre(1, -1));
    EXPECT_THAT(reliefsOf(twoSided("<bsdf type=\"diffuse\"/>" + normals)), ElementsAre(-1));
    EXPECT_THAT(reliefsOf("<bsdf type=\"mask\"><texture name=\"opacity\" type=\"checkerboard\"/>" +
                          twoSided(bumps) + "</bsdf>"),
                ElementsAre(0.5f, -0.5f));
    EXPECT_THAT(reliefsOf(twoSided("<bsdf type=\"diffuse\"/>")), ElementsAre());
    const Scene mixed = loadInside(rectangleOf(
        twoSided("<bsdf type=\"blendbsdf\">" + bumps + "<bsdf type=\"diffuse\"/></bsdf>")));
    for (const Material& m : mixed.materials)
        EXPECT_TRUE(m.mirrorsReliefBehind) << "a mixture with relief is mirrored, too";
}

} // namespace
} // namespace stromboli::test

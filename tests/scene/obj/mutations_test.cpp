// Damaged files end in a scene or a SceneError: never in a crash, a hang or another exception.
// Fixed seeds; worth running with STROMBOLI_SANITIZE=address,undefined.

#include "tests/scene/obj/obj_folder.hpp"

#include <cmath>
#include <random>

namespace stromboli::test {
namespace {

const std::string kObj =
    "mtllib m.mtl\no box\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 -1\nvt 0 0\nvt 1 0\n"
    "vt 1 1\nvn 0 0 1\nvn 0 0.6 0.8\ng top\nusemtl a\ns 1\nf 1/1/1 2/2/1 3/3/2 4/1/2\nf -1 -2 -3\n"
    "usemtl b\ng side\nf 1//1 2//2 5//1\nl 1 2\nf 1 5 2 \\\n 3 4\n";
const std::string kMtl =
    "newmtl a\nKd 0.5 0.5 0.5\nKs 0.2 0.2 0.2\nNs 30\nd 0.5\nmap_Kd -s 2 2 -clamp on a.png\n"
    "newmtl b\nPr 0.2\nPm 1\naniso 0.5\nKe 1 2 3\nillum 2\n";

void expectSound(const Scene& scene) {
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        ASSERT_LT(t.material, scene.materials.size());
        ASSERT_LT(t.instance, scene.instances.size());
        for (int k = 0; k < 3; ++k) {
            ASSERT_LT(t.corner[k], scene.positions.size());
            ASSERT_TRUE(t.normals[k] == kNoNormals || t.normals[k] < scene.normals.size());
            if (scene.attributeCorners.empty()) continue;
            const uint32_t attributes = scene.attributeCorners[i][k];
            ASSERT_TRUE(attributes == kNoAttributes || attributes < scene.attributes.size());
        }
    }
    for (const VertexAttributes& a : scene.attributes)
        ASSERT_TRUE(std::isfinite(a.uv[0].x + a.uv[0].y + a.color.x + a.tangent.x));
    for (const Material& m : scene.materials) {
        const PrincipledParameters& p = m.principled;
        ASSERT_TRUE(std::isfinite(m.albedo.x + m.emission.x + m.opacity + p.roughness + p.ior +
                                  p.specularColor.x + p.anisotropyRotation));
    }
}

std::string mutated(std::string text, std::mt19937& random) {
    const char* const words[] = {
        " -1 ", " 0 ",   " 4294967295 ", " 1e308 ", " -2147483649 ", "/", "\\\n",
        "\nf ", " nan ", "\nv ",         "\n",      "\nusemtl ",     "#", " 1e-400 "};
    for (unsigned k = 0; k <= random() % 3; ++k) {
        const size_t at = random() % text.size();
        switch (random() % 4) {
        case 0:
            text[at] ^= char(1u << (random() % 8));
            break;
        case 1:
            text.insert(at, words[random() % std::size(words)]);
            break;
        case 2:
            text.erase(at, 1 + random() % 10);
            break;
        default:
            text.insert(at, text.substr(random() % text.size(), random() % 40));
        }
        if (text.empty()) text = "v";
    }
    return text;
}

TEST(ObjMutations, EndInASceneOrAnError) {
    std::mt19937 random(3);
    const ObjFolder folder;
    int forgiven = 0, errors = 0;
    for (int i = 0; i < 4000; ++i) {
        folder.write("m.mtl", i % 2 ? mutated(kMtl, random) : kMtl);
        try {
            const Scene scene = folder.load(i % 2 ? kObj : mutated(kObj, random));
            expectSound(scene);
            forgiven += !scene.report.forgiven.empty();
        } catch (const SceneError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            ++errors;
        }
    }
    EXPECT_GT(forgiven, 500);
    EXPECT_GT(errors, 10);
}

} // namespace
} // namespace stromboli::test

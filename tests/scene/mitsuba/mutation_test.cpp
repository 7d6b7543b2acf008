// Damaged scenes: an error or a scene, never a crash.

#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <random>

namespace stromboli::test {
namespace {

const char* const kScene = R"(<scene version="3.0.0">
<default name="d" value="3"/>
<integrator type="path"><integer name="max_depth" value="$d"/></integrator>
<sensor type="perspective"><float name="fov" value="40"/>
<transform name="to_world"><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform>
<film type="hdrfilm"><integer name="width" value="8"/><rfilter type="box"/></film></sensor>
<bsdf type="diffuse" id="m"><rgb name="reflectance" value="0.2 0.5 1"/></bsdf>
<bsdf type="mask" id="k"><float name="opacity" value="0.5"/><ref id="m"/></bsdf>
<shape type="rectangle"><ref id="k"/><emitter type="area"><spectrum name="radiance"
 value="400:0, 500:8"/></emitter></shape>
<shape type="shapegroup" id="g"><shape type="cube"><bsdf type="roughconductor">
<string name="material" value="Au"/></bsdf></shape></shape>
<shape type="instance"><ref id="g"/><transform name="to_world"><scale value="2"/></transform></shape>
<medium type="heterogeneous" id="f"><volume name="sigma_t" type="gridvolume">
<string name="filename" value="mutated.vol"/></volume><rgb name="albedo" value="0.5 0.9 1"/>
<phase type="hg"><float name="g" value="0.5"/></phase></medium><shape type="sphere"><ref name="interior" id="f"/><medium name="exterior"
 type="homogeneous"><float name="sigma_t" value="2"/></medium><bsdf type="null"/></shape>
<emitter type="point"><rgb name="intensity" value="1"/></emitter></scene>
)";

/// A file of Mitsuba 0.x: what takes the place of others, and files beside the scene's.
const char* const kOldScene = R"(<scene version="0.6.0">
<integrator type="sppm"><integer name="maxDepth" value="3"/></integrator>
<sensor type="perspective"><film type="ldrfilm"><integer name="width" value="8"/>
<rfilter type="mitchell"><float name="B" value="0.3"/></rfilter></film></sensor>
<texture type="scale" id="t"><float name="scale" value="0.5"/><texture type="bitmap">
<string name="filename" value="mutated.tga"/><string name="channel" value="a"/>
<float name="uoffset" value="0.5"/></texture></texture>
<bsdf type="phong" id="p"><ref name="diffuseReflectance" id="t"/></bsdf>
<bsdf type="mixturebsdf" id="m"><string name="weights" value="0.5 0.3"/>
<bsdf type="coating"><bsdf type="ward"/></bsdf><bsdf type="hk"><rgb name="sigmaT" value="1 2 3"/>
</bsdf></bsdf>
<bsdf type="mask" id="k"><texture name="opacity" type="gridtexture"/><ref id="p"/></bsdf>
<shape type="heightfield"><string name="filename" value="mutated.tga"/><ref id="m"/></shape>
<shape type="hair"><string name="filename" value="mutated.hair"/><ref id="k"/></shape>
<shape type="obj"><string name="filename" value="mutated.obj"/><float name="maxSmoothAngle" value="30"/>
<bsdf type="difftrans" name="a"/><bsdf type="twosided" name="b"><ref id="m"/></bsdf></shape>
<emitter type="point"><blackbody name="intensity" temperature="3000K"/></emitter></scene>
)";

void change(std::string& text, const std::string& original, std::mt19937& random) {
    const size_t at = random() % text.size();
    const size_t length = std::min<size_t>(random() % 12, text.size() - at);
    switch (random() % 4) {
    case 0:
        text[at] = char(random() % 128);
        break;
    case 1:
        text.erase(at, length);
        break;
    case 2:
        text.insert(at, original, random() % original.size(), length);
        break;
    default: // another digit
        if (const size_t digit = text.find_first_of("0123456789", at); digit != std::string::npos)
            text[digit] = "0123456789-.e$"[random() % 14];
    }
    if (text.empty()) text = " ";
}

/// Whether there is anything to show of it.
bool isShown(const std::string& text) {
    try {
        loadText(text);
        return true;
    } catch (const SceneError&) {
        return false;
    }
}

/// Mitsuba's format of volumes: one cell of the density 1, as bytes.
std::string volume() {
    using namespace std::string_literals;
    const std::string one = "\1\0\0\0"s, zero = "\0\0\0\0"s, oneAsFloat = "\0\0\x80\x3f"s;
    std::string bytes = "VOL\3";
    for (int i = 0; i < 5; ++i) // encoding, sizes, channels
        bytes += one;
    bytes += zero + zero + zero + oneAsFloat + oneAsFloat + oneAsFloat + oneAsFloat;
    return bytes;
}

TEST(MitsubaMutations, NeverCrash) {
    writeFile("mutated.vol", volume());
    ASSERT_EQ(problemOf(kScene), "");
    std::mt19937 random(1);
    size_t loaded = 0, shown = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string text = kScene;
        for (uint64_t changes = 1 + random() % 3; changes > 0; --changes)
            change(text, kScene, random);
        std::string damaged = volume();
        if (i % 4 == 0) change(damaged, volume(), random);
        writeFile("mutated.vol", damaged);
        loaded += problemOf(text).empty() ? 1 : 0;
        shown += isShown(text) ? 1 : 0;
    }
    EXPECT_GT(loaded, 50u);
    EXPECT_GT(shown, loaded);
}

TEST(MitsubaMutations, OldScenesAndTheirFilesNeverCrash) {
    const std::string picture = "mutated.tga", hair = "mutated.hair", mesh = "mutated.obj";
    writePicture(picture, 2, 2, {{255, 0, 0, 9}, {1, 2, 3, 99}, {4, 5, 6, 7}, {8, 9, 9, 9}});
    const std::string strands = "0 0 0\n0 0 1\n0 1 1\n\n1 1 1\n2 2 2\n";
    const std::string triangles = "mtllib mutated.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 1\n"
                                  "usemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 3 2 1\n";
    writeFile("mutated.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
    writeFile(hair, strands);
    writeFile(mesh, triangles);
    ASSERT_TRUE(isShown(kOldScene));
    std::mt19937 random(2);
    size_t shown = 0;
    for (int i = 0; i < 1500; ++i) {
        std::string text = kOldScene, damagedHair = strands, damagedMesh = triangles;
        for (uint64_t changes = 1 + random() % 3; changes > 0; --changes)
            change(text, kOldScene, random);
        change(damagedHair, strands, random);
        change(damagedMesh, triangles, random);
        writeFile(hair, damagedHair);
        writeFile(mesh, damagedMesh);
        shown += isShown(text) ? 1 : 0;
    }
    EXPECT_GT(shown, 300u); // the others are no XML any more
}

} // namespace
} // namespace stromboli::test

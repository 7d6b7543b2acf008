// Damaged scenes: an error or a scene, never a crash.

#include "tests/scene/pbrt/pbrt_text.hpp"

#include <random>

namespace stromboli::test {
namespace {

const char* const kNew = R"(LookAt 0 0 5 0 0 0 0 1 0
Camera "perspective" "float fov" 40 "float lensradius" .1
Film "rgb" "integer xresolution" 8 "integer yresolution" 8 "float iso" 200
PixelFilter "mitchell" Integrator "path" "integer maxdepth" 3
WorldBegin
LightSource "infinite" "rgb L" [.1 .1 .1]
LightSource "spot" "blackbody I" 3000 "point3 from" [0 4 0] "point3 to" [0 0 0]
Texture "c" "spectrum" "checkerboard" "float uscale" 3 "rgb tex1" [1 0 0] "float vscale" 2
Texture "p" "spectrum" "imagemap" "string filename" "mutated.tga" "float scale" .5
Texture "m" "spectrum" "mix" "texture tex1" "c" "texture tex2" "p" "float amount" .3
MakeNamedMaterial "a" "string type" "coateddiffuse" "texture reflectance" "m" "float roughness" .2
MakeNamedMaterial "b" "string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" [400 1 700 3]
AttributeBegin Material "mix" "string materials" ["a" "b"] "float amount" .25
Translate 1 0 0 Rotate 30 0 1 0 Shape "sphere" "float radius" .5 "float phimax" 200 AttributeEnd
ObjectBegin "o" NamedMaterial "a" Shape "loopsubdiv" "integer levels" 1 "point3 P" [0 0 0 1 0 0 0 1 0]
"integer indices" [0 1 2] Shape "curve" "point3 P" [0 0 0 1 0 0 2 0 0 3 1 0] ObjectEnd
ObjectInstance "o" Scale 2 2 2 ObjectInstance "o"
MakeNamedMedium "f" "string type" "uniformgrid" "integer nx" 2 "float density" [1 2] "point3 p1" [2 1 1]
"float temperature" [900 3000] "float Lescale" [1 .5] "float temperatureoffset" 100
MakeNamedMedium "h" "string type" "rgbgrid" "integer nx" 2 "rgb sigma_a" [1 2 3 4 5 6] "rgb Le" [1 1 1 0 0 4]
MediumInterface "h" "g" Material "interface" Shape "sphere" "float radius" .25
MakeNamedMedium "g" "string type" "homogeneous" "rgb sigma_s" [1 2 3] "rgb Le" [1 1 1] "float g" .5
MediumInterface "f" "g" Material "interface" Shape "sphere"
AreaLightSource "diffuse" "rgb L" [5 4 3] "float power" 20
Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1]
)";

const char* const kOld = R"(Film "image" "integer xresolution" [8] "float cropwindow" [0 .5 0 1]
Camera "orthographic" "float screenwindow" [-1 1 -1 1]
WorldBegin
LightSource "infinite" "string mapname" "mutated.hdr" "color scale" [2 2 2]
Texture "d" "float" "dots" "float uscale" 4
Texture "s" "color" "scale" "texture tex1" "d" "color tex2" [.5 .5 1]
Material "uber" "texture Kd" "s" "color Kr" [.1 .1 .1] "float roughness" .3
TransformBegin Scale -1 1 1 Shape "cone" "float height" 2 "color Kd" [1 0 0] TransformEnd
Material "disney" "float metallic" .5 Shape "heightfield" "integer nu" 2 "integer nv" 2 "float Pz" [0 1 2 3]
Material "translucent" Shape "nurbs" "integer nu" 3 "integer uorder" 3 "float uknots" [0 0 0 1 1 1]
"integer nv" 2 "integer vorder" 2 "float vknots" [0 0 1 1] "point P" [0 0 0 1 0 0 2 0 1 0 1 0 1 1 0 2 1 0]
Material "plastic" Shape "trianglemesh" "integer indices" [0 1 2] "point P" [0 0 0 1 0 0 0 1 0]
"float uv" [0 0 1 0 1 1] "float alpha" 0.5
WorldEnd
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
            text[digit] = "0123456789-.e\""[random() % 14];
    }
    if (text.empty()) text = " ";
}

/// How many of so many damaged scenes show something.
size_t shownOf(const std::string& original, int count, unsigned seed) {
    std::mt19937 random(seed);
    size_t shown = 0;
    for (int i = 0; i < count; ++i) {
        std::string text = original;
        for (uint64_t changes = 1 + random() % 3; changes > 0; --changes)
            change(text, original, random);
        try {
            loadText(text);
            ++shown;
        } catch (const SceneError&) {
        }
    }
    return shown;
}

TEST(PbrtMutations, NeverCrash) {
    writePicture("mutated.tga", 2, 2, {{255, 0, 0}, {1, 2, 3}, {4, 5, 6}, {8, 9, 9}});
    writeLight("mutated.hdr", 2, 1, {{1, 1, 1}, {2, 2, 2}});
    ASSERT_FALSE(loadText(kNew).triangles.empty());
    ASSERT_FALSE(loadText(kOld).triangles.empty());
    EXPECT_GT(shownOf(kNew, 120, 1), 80u);
    EXPECT_GT(shownOf(kOld, 120, 2), 80u);
}

} // namespace
} // namespace stromboli::test

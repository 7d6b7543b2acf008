// Files of formats that Assimp reads. Without its library the program says how to install it, which
// is all that is asked for then.

#include "scene/assimp/load_assimp.hpp"

#include "tests/scene/assimp/assimp_folder.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

/// Assimp keeps some memory of an import that has failed; what the program leaks is still found.
/// The sanitizer finds the function only where it is seen from outside.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() {
    return "leak:libassimp";
}

namespace stromboli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST_F(AssimpFiles, StlHasItsTriangles) {
    const std::optional<Scene> scene = read(write("a.STL", kStl));
    if (!scene) GTEST_SKIP() << "Assimp is not installed";
    EXPECT_EQ(scene->triangles.size(), 2u);
    EXPECT_EQ(scene->bounds().hi, glm::vec3(2, 3, 0));
    for (const Triangle& t : scene->triangles)
        EXPECT_NEAR(scene->geometricNormal(t).z, 1, 1e-6);
    EXPECT_EQ(scene->lights.size(), 1u) << "the default light";
    EXPECT_TRUE(scene->cameras.empty());
}

/// Assimp ended the program.
TEST_F(AssimpFiles, WhatIsEmptyIsAnError) {
    if (!read(write("a.stl", kStl))) GTEST_SKIP() << "Assimp is not installed";
    for (const char* name : {"empty.stl", "empty.3ds", "empty.fbx"})
        try {
            read(write(name, ""));
            ADD_FAILURE() << name;
        } catch (const SceneError& error) {
            EXPECT_THAT(error.what(), HasSubstr("is empty: expected a scene"));
        }
    for (const std::string& bytes : {std::string("x"), std::string(84, '\0')})
        EXPECT_THROW(read(write("short.stl", bytes)), SceneError);
}

TEST_F(AssimpFiles, BlenderFilesOfTodayAreToldToBeExported) {
    if (!read(write("a.stl", kStl))) GTEST_SKIP() << "Assimp is not installed";
    const auto messageOf = [&](const std::string& bytes) -> std::string {
        try {
            read(write("a.blend", bytes));
        } catch (const SceneError& error) {
            return error.what();
        }
        return "no error";
    };
    for (const char* bytes :
         {"BLENDER-v293", "BLENDER-v306 ", "BLENDER17-01v0500", "\x28\xB5\x2F\xFD"})
        EXPECT_THAT(messageOf(bytes), HasSubstr("glTF 2.0 (.glb)")) << bytes;
    EXPECT_THAT(messageOf("BLENDER-v279"), testing::Not(HasSubstr("glTF")));
}

/// Its camera sees 90 degrees between the borders of its picture, and its lamp fades by the square
/// of the distance, which a modeller draws from 25 m on.
const char* const kFbx = R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
 FBXHeaderVersion: 1003
 FBXVersion: 7400
}
GlobalSettings:  {
 Version: 1000
 Properties70:  {
  P: "UnitScaleFactor", "double", "Number", "",100
 }
}
Objects:  {
 Geometry: 1, "Geometry::plane", "Mesh" {
  Vertices: *9 {
   a: -1,-1,-2,1,-1,-2,0,1,-2
  }
  PolygonVertexIndex: *3 {
   a: 0,1,-3
  }
  GeometryVersion: 124
 }
 Model: 2, "Model::plane", "Mesh" {
  Version: 232
 }
 NodeAttribute: 3, "NodeAttribute::cam", "Camera" {
  TypeFlags: "Camera"
  Properties70:  {
   P: "FieldOfView", "FieldOfView", "", "A",90
  }
 }
 Model: 4, "Model::cam", "Camera" {
  Version: 232
 }
 NodeAttribute: 5, "NodeAttribute::lamp", "Light" {
  TypeFlags: "Light"
  Properties70:  {
   P: "LightType", "enum", "", "",0
   P: "Color", "Color", "", "A",1,1,1
   P: "Intensity", "Number", "", "A",300
   P: "DecayType", "enum", "", "",2
   P: "DecayStart", "double", "Number", "",2500
  }
 }
 Model: 6, "Model::lamp", "Light" {
  Version: 232
 }
}
Connections:  {
 C: "OO",2,0
 C: "OO",1,2
 C: "OO",4,0
 C: "OO",3,4
 C: "OO",6,0
 C: "OO",5,6
}
)";

TEST_F(AssimpFiles, OffMayHaveColoursOfBytes) {
    for (const char* colors : {"255 188 0 255", "255 188 0 1", "1.0 0.7373 0.0 1.0"}) {
        const std::string corner = std::string(" ") + colors + "\n";
        const std::optional<Scene> scene =
            read(write("a.off", "COFF\n3 1 0\n0 0 0" + corner + "1 0 0" + corner + "0 1 0" +
                                    corner + "3 0 1 2\n"));
        if (!scene) GTEST_SKIP() << "Assimp is not installed";
        ASSERT_EQ(scene->attributes.size(), 3u) << colors;
        const glm::vec4 color = scene->attributes[0].color;
        EXPECT_NEAR(color.r, 1, 1e-3);
        EXPECT_NEAR(color.g, 0.5, 3e-3) << "of a screen: 188 of 255 is half of the light";
        EXPECT_NEAR(color.b, 0, 1e-3);
        EXPECT_EQ(color.a, 1);
        EXPECT_TRUE(scene->report.warnings.empty());
    }
}

TEST_F(AssimpFiles, FbxHasItsAnglesAndDecays) {
    const std::optional<Scene> scene = read(write("a.fbx", kFbx));
    if (!scene) GTEST_SKIP() << "Assimp is not installed";
    ASSERT_EQ(scene->cameras.size(), 1u);
    ASSERT_TRUE(scene->cameras[0].halfWidth);
    EXPECT_NEAR(*scene->cameras[0].halfWidth, 1, 1e-6);
    ASSERT_EQ(scene->lights.size(), 1u);
    const Light& lamp = scene->lights[0];
    EXPECT_EQ(lamp.color, glm::vec3(3));
    EXPECT_EQ(lamp.constantAttenuation, 0);
    EXPECT_EQ(lamp.quadraticAttenuation, 1);
    // One that does not fade has its intensity anywhere.
    std::string steady = kFbx;
    const std::string type = "P: \"DecayType\", \"enum\", \"\", \"\",";
    steady.replace(steady.find(type) + type.size(), 1, "0");
    const Scene unfading = *read(write("b.fbx", steady));
    EXPECT_EQ(unfading.lights.at(0).constantAttenuation, 1);
    EXPECT_EQ(unfading.lights.at(0).quadraticAttenuation, 0);
}

/// Blender writes the metallic share of its surfaces as what they reflect.
TEST_F(AssimpFiles, FbxOfBlenderHasItsMetals) {
    const auto withGold = [](const std::string& creator) {
        std::string text = kFbx;
        const auto insert = [&](const std::string& behind, const std::string& what) {
            text.insert(text.find(behind) + behind.size(), what);
        };
        insert("FBXVersion: 7400\n", " Creator: \"" + creator + "\"\n");
        insert("Objects:  {\n", R"( Material: 7, "Material::gold", "" {
  Version: 102
  ShadingModel: "Phong"
  Properties70:  {
   P: "DiffuseColor", "Color", "", "A",1,0.7,0.3
   P: "ReflectionFactor", "Number", "", "A",0.75
   P: "Shininess", "Number", "", "A",64
   P: "ShininessExponent", "Number", "", "A",64
  }
 }
)");
        insert("GeometryVersion: 124\n", R"(  LayerElementMaterial: 0 {
   Version: 101
   Name: ""
   MappingInformationType: "AllSame"
   ReferenceInformationType: "IndexToDirect"
   Materials: *1 {
    a: 0
   }
  }
  Layer: 0 {
   Version: 100
   LayerElement:  {
    Type: "LayerElementMaterial"
    TypedIndex: 0
   }
  }
)");
        insert("C: \"OO\",1,2\n", " C: \"OO\",7,2\n");
        return text;
    };
    const std::optional<Scene> scene =
        read(write("a.fbx", withGold("Blender (stable FBX IO) - 4.5.15 LTS - 5.13.1")));
    if (!scene) GTEST_SKIP() << "Assimp is not installed";
    const PrincipledParameters& p = scene->materials.at(scene->triangles.at(0).material).principled;
    EXPECT_FLOAT_EQ(p.metallic, 0.75f);
    EXPECT_NEAR(p.roughness, 0.2, 1e-5);
    const Scene other = *read(write("b.fbx", withGold("FBX SDK/FBX Plugins version 2018")));
    EXPECT_EQ(other.materials.at(other.triangles.at(0).material).principled.metallic, 0);
}

TEST_F(AssimpFiles, StlInCapitalsHasItsTrianglesToo) {
    std::string text = kStl;
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return char(std::toupper(c)); });
    const std::optional<Scene> scene = read(write("a.stl", text));
    if (!scene) GTEST_SKIP() << "Assimp is not installed";
    EXPECT_EQ(scene->triangles.size(), 2u);
    EXPECT_EQ(scene->bounds().hi, glm::vec3(2, 3, 0));
}

TEST_F(AssimpFiles, PolygonsAreTriangles) {
    const std::optional<Scene> scene =
        read(write("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"));
    if (!scene) GTEST_SKIP() << "Assimp is not installed";
    EXPECT_EQ(scene->triangles.size(), 2u);
    EXPECT_EQ(scene->bounds().hi, glm::vec3(1, 1, 0));
}

TEST_F(AssimpFiles, WhatAssimpCannotReadIsOneErrorWithItsWords) {
    const std::string file = write("a.stl", "solid broken\nfacet normal 0 0\n");
    try {
        const std::optional<Scene> scene = read(file);
        if (!scene) GTEST_SKIP() << "Assimp is not installed";
        ADD_FAILURE() << "was read";
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file + ": Assimp: "));
    }
}

TEST_F(AssimpFiles, FilesThatAreNotThereAreSaidToBe) {
    EXPECT_THROW(readScene((folder / "none.fbx").string()), SceneError);
}

TEST_F(AssimpFiles, AnUnknownEndingIsStillAnError) {
    const std::string file = write("a.nosuch", "nothing");
    try {
        readScene(file);
        ADD_FAILURE() << "was read";
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(), HasSubstr("in no format that is read"));
        EXPECT_THAT(error.what(), HasSubstr(".stl"));
    }
}

TEST(AssimpFormats, AreToldByTheirEndings) {
    EXPECT_TRUE(isAssimpFormat(".fbx"));
    EXPECT_TRUE(isAssimpFormat(".3ds"));
    EXPECT_FALSE(isAssimpFormat(".obj")) << "read by the program itself";
    EXPECT_FALSE(isAssimpFormat(""));
}

struct Sample {
    const char* file;
    size_t triangles;
};

/// Files that other programs wrote: their triangles, and that what they name is found.
TEST(AssimpSamples, AreRead) {
    const fs::path models = "/usr/share/assimp/models";
    if (!fs::exists(models)) GTEST_SKIP() << "the package assimp-testmodels is not installed";
    const Sample samples[] = {{"STL/Spider_binary.stl", 1368},
                              {"FBX/box.fbx", 12},
                              {"3DS/cube_with_diffuse_texture.3DS", 12},
                              {"X/test.x", 12},
                              {"LWO/LWO2/boxuv.lwo", 12},
                              {"MS3D/jeep1.ms3d", 2368}};
    for (const Sample& sample : samples) {
        SCOPED_TRACE(sample.file);
        if (!fs::exists(models / sample.file)) continue;
        try {
            const Scene scene = readScene((models / sample.file).string());
            EXPECT_LE(scene.triangles.size(), sample.triangles);
            EXPECT_GE(scene.triangles.size(), sample.triangles * 8 / 10)
                << "but those without area";
            EXPECT_FALSE(scene.bounds().empty());
        } catch (const SceneError& error) {
            if (!(std::string(error.what()).find("apt install libassimp") != std::string::npos))
                throw;
            GTEST_SKIP() << "Assimp is not installed";
        }
    }
}

/// Lengths of FBX files are centimetres, and those in which lights fall off as well.
TEST(AssimpSamples, UnitsAreMetres) {
    const fs::path file = "/usr/share/assimp/models/FBX/spider.fbx";
    if (!fs::exists(file)) GTEST_SKIP() << "the package assimp-testmodels is not installed";
    try {
        SceneConventions inUnits;
        inUnits.applyUnit = false;
        const float metres = readScene(file.string()).bounds().extent().x;
        const float units = readScene(file.string(), inUnits).bounds().extent().x;
        EXPECT_NEAR(metres, units / 100, 1e-4f * units);
    } catch (const SceneError& error) {
        if (!(std::string(error.what()).find("apt install libassimp") != std::string::npos)) throw;
        GTEST_SKIP() << "Assimp is not installed";
    }
}

} // namespace
} // namespace stromboli

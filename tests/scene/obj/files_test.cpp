// Files that other programs wrote: those of Debian's package assimp-testmodels.

#include "tests/scene/obj/obj_folder.hpp"

#include <algorithm>
#include <map>
#include <vector>

namespace stromboli::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kAssimp = "/usr/share/assimp/models";

TEST(ObjFiles, AssimpsModelsLoadOrSayWhatIsWrong) {
    if (!fs::exists(kAssimp)) GTEST_SKIP() << "the package assimp-testmodels is not installed";
    const std::map<std::string, std::string> wrong = {
        {"empty.obj", "has no vertex"},
    };
    const std::vector<std::string> withoutFaces = {"point_cloud.obj", "testline.obj",
                                                   "testpoints.obj"};
    size_t count = 0;
    for (const char* folder : {"OBJ", "invalid"})
        for (const auto& entry : fs::directory_iterator(kAssimp / folder)) {
            if (entry.path().extension() != ".obj") continue;
            ++count;
            const std::string name = entry.path().filename().string();
            const auto expected = wrong.find(name);
            try {
                const Scene scene = loadObj(entry.path());
                EXPECT_EQ(expected, wrong.end()) << name;
                const bool isEmpty =
                    std::find(withoutFaces.begin(), withoutFaces.end(), name) != withoutFaces.end();
                EXPECT_EQ(scene.triangles.empty(), isEmpty) << name;
            } catch (const SceneError& error) {
                ASSERT_NE(expected, wrong.end()) << error.what();
                EXPECT_THAT(error.what(), HasSubstr(expected->second));
            }
        }
    EXPECT_GE(count, 25u);
}

} // namespace
} // namespace stromboli::test

// Files that other programs wrote: those of Debian's package assimp-testmodels.

#include "tests/scene/ply/ply_text.hpp"

#include <map>

namespace stromboli::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kAssimp = "/usr/share/assimp/models";

TEST(PlyFiles, AssimpsModelsLoadOrSayWhatIsWrong) {
    if (!fs::exists(kAssimp)) GTEST_SKIP() << "the package assimp-testmodels is not installed";
    const std::map<std::string, std::string> wrong = {
        {"empty.ply", "is no PLY file"},
        {"issue623.ply", "issue623.ply:14: <vertex[0]>: the length of the list"},
        {"pond.0.ply", "<vertex>: the header says that there are 70051"}, // bytes are missing
    };
    size_t count = 0;
    for (const char* folder : {"PLY", "invalid"})
        for (const auto& entry : fs::directory_iterator(kAssimp / folder)) {
            if (entry.path().extension() != ".ply") continue;
            ++count;
            const std::string name = entry.path().filename().string();
            const auto expected = wrong.find(name);
            try {
                const Scene scene = loadPly(entry.path());
                EXPECT_EQ(expected, wrong.end()) << name;
                EXPECT_EQ(scene.triangles.empty(), name == "points.ply") << name;
            } catch (const SceneError& error) {
                ASSERT_NE(expected, wrong.end()) << error.what();
                EXPECT_THAT(error.what(), HasSubstr(expected->second));
            }
        }
    EXPECT_GE(count, 9u);
}

} // namespace
} // namespace stromboli::test

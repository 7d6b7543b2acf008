// `stromboli kernels`: what Mesa's driver for AMD GPUs makes of the kernels, without such a GPU;
// and that the table in docs/results.md says so.
#include "source_dir.h"
#include "tests/cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

struct Row {
    double registers = 0, spilled = 0, scratch = 0, shared = 0, instructions = 0, waves = 0,
           lanes = 0;
};

std::istream& operator>>(std::istream& in, Row& r) {
    return in >> r.registers >> r.spilled >> r.scratch >> r.shared >> r.instructions >> r.waves >>
           r.lanes;
}

bool hasRadv() {
    return std::filesystem::exists("/usr/share/vulkan/icd.d/radeon_icd.x86_64.json");
}

ProgramRun kernelsOf(std::vector<std::string> scenes, const std::string& family = "navi21") {
    std::vector<std::string> command = {"kernels", "--device-family", family, "-q"};
    command.insert(command.begin() + 1, scenes.begin(), scenes.end());
    return stromboli(command);
}

using Rows = std::map<std::string, Row>; ///< by the names of the kernels

/// By the names of the scenes: lines without a number, after the empty ones.
std::map<std::string, Rows> rowsOf(const std::string& printed) {
    std::map<std::string, Rows> scenes;
    std::istringstream lines(printed);
    std::string scene;
    bool isName = false;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string kernel;
        Row row;
        if (isName)
            scene = line;
        else if (words >> kernel >> row)
            scenes[scene][kernel] = row;
        isName = line.empty();
    }
    return scenes;
}

/// The goal that the wavefront scheduler is there for: nothing is spilled, rays are traced in eight
/// waves, and no other stage has less than seven.
TEST(Kernels, OfTheWavefrontSchedulerFitAGpu) {
    if (!hasRadv()) GTEST_SKIP() << "Mesa's driver for AMD GPUs is not installed";
    const std::vector<std::string> scenes = {
        "cornell_boxes",     "cornell_mesh", "cornell_metal",
        "cornell_spheres",   "island",       "cornell_mirror_glass",
        "light_ambient",     "light_area",   "light_mesh",
        "light_directional", "light_point",  "light_sphere",
        "light_spot",        "ortho",        "still_life",
        "texture_chart"};
    const ProgramRun run = kernelsOf(scenes);
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const std::map<std::string, Rows> found = rowsOf(run.out);
    for (const std::string& scene : scenes) {
        ASSERT_TRUE(found.contains(scene)) << run.out;
        const Rows& rows = found.at(scene);
        ASSERT_EQ(rows.size(), 5u) << run.out;
        // Where light samples go through glass, the surface that waits for one is kept, too.
        const bool keepsTwo =
            stromboli({"info", scene}).out.find("light samples through glass") != std::string::npos;
        for (const char* kernel : {"depart", "trace", "follow", "light"}) {
            EXPECT_EQ(rows.at(kernel).spilled, 0) << scene << ", " << kernel;
            EXPECT_EQ(rows.at(kernel).scratch, 0) << scene << ", " << kernel;
            const bool keeps = keepsTwo && kernel == std::string("follow");
            EXPECT_GE(rows.at(kernel).waves, keeps ? 5 : 7) << scene << ", " << kernel;
        }
        EXPECT_GE(rows.at("trace").waves, 8) << scene;
    }
}

/// Subgroups of 32 lanes where the GPU has them (RDNA2), though its driver would choose 64; an
/// older one has no others.
TEST(Kernels, AskForNarrowSubgroups) {
    if (!hasRadv()) GTEST_SKIP() << "Mesa's driver for AMD GPUs is not installed";
    for (const auto& [family, lanes] : {std::pair("navi21", 32), std::pair("vega10", 64)}) {
        const ProgramRun run = kernelsOf({"light_point"}, family);
        ASSERT_EQ(run.exitCode, 0) << run.err;
        const std::map<std::string, Rows> found = rowsOf(run.out);
        ASSERT_TRUE(found.contains("light_point")) << run.out;
        for (const auto& [kernel, row] : found.at("light_point"))
            EXPECT_EQ(row.lanes, lanes) << family << ", " << kernel;
    }
}

/// Rows `| scene | kernel | registers | spilled | scratch | instructions | waves |` of the section.
TEST(Kernels, AreAsTheResultsSay) {
    if (!hasRadv()) GTEST_SKIP() << "Mesa's driver for AMD GPUs is not installed";
    std::ifstream file(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "docs/results.md");
    std::map<std::string, Rows> stated;
    bool isIn = false;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("## ")) isIn = line == "## Kernels on a GPU that is not there";
        if (!isIn || !line.starts_with("| `")) continue;
        std::vector<std::string> cells;
        std::istringstream all(line.substr(1));
        for (std::string cell; std::getline(all, cell, '|');)
            cells.push_back(cell.substr(1, cell.size() - 2));
        ASSERT_EQ(cells.size(), 7u) << line;
        Row row;
        row.registers = std::stod(cells[2]), row.spilled = std::stod(cells[3]);
        row.scratch = std::stod(cells[4]), row.instructions = std::stod(cells[5]);
        row.waves = std::stod(cells[6]);
        stated[cells[0].substr(1, cells[0].size() - 2)][cells[1]] = row;
    }
    ASSERT_GE(stated.size(), 4u);
    std::vector<std::string> scenes;
    for (const auto& [scene, kernels] : stated)
        scenes.push_back(scene);
    const ProgramRun run = kernelsOf(scenes);
    ASSERT_EQ(run.exitCode, 0) << run.err;
    if (run.out.find("Mesa 22.3") == std::string::npos) GTEST_SKIP() << "the table is of Mesa 22.3";
    const std::map<std::string, Rows> all = rowsOf(run.out);
    for (const auto& [scene, kernels] : stated) {
        ASSERT_TRUE(all.contains(scene)) << run.out;
        const Rows& found = all.at(scene);
        for (const auto& [kernel, row] : kernels) {
            ASSERT_TRUE(found.contains(kernel)) << kernel;
            const Row& f = found.at(kernel);
            EXPECT_NEAR(f.registers, row.registers, 16) << scene << ", " << kernel;
            EXPECT_NEAR(f.waves, row.waves, 2) << scene << ", " << kernel;
            EXPECT_NEAR(f.instructions, row.instructions, 0.1 * row.instructions)
                << scene << ", " << kernel;
            EXPECT_NEAR(f.spilled, row.spilled, 0.25 * row.spilled) << scene << ", " << kernel;
            EXPECT_EQ(f.scratch > 0, row.scratch > 0) << scene << ", " << kernel;
        }
    }
}

TEST(Kernels, SayWhatIsMissing) {
    const ProgramRun family = stromboli({"kernels", "cornell_boxes", "--device-family", "voodoo"});
    EXPECT_EQ(family.exitCode, 1);
    EXPECT_THAT(family.err, HasSubstr("voodoo"));
    EXPECT_THAT(family.err, HasSubstr("navi21"));
    const ProgramRun cpu = stromboli({"kernels", "cornell_boxes", "--device", "llvmpipe"});
    if (cpu.err.find("llvmpipe") == std::string::npos) GTEST_SKIP() << "no llvmpipe";
    EXPECT_EQ(cpu.exitCode, 3);
    EXPECT_THAT(cpu.err, HasSubstr("VK_KHR_pipeline_executable_properties"));
}

/// A driver that only compiles reports no memory; to render with it is refused, in a line.
TEST(Kernels, ADriverWithoutHardwareDoesNotRender) {
    if (!hasRadv()) GTEST_SKIP() << "Mesa's driver for AMD GPUs is not installed";
    const ScratchFolder folder;
    const ProgramRun run = stromboli(
        {"render", "cornell_boxes", "-r", "8", "8", "-s", "1", "-o", folder.file("a.png")},
        "RADV_FORCE_FAMILY=navi21 "
        "VK_ICD_FILENAMES=/usr/share/vulkan/icd.d/radeon_icd.x86_64.json");
    EXPECT_EQ(run.exitCode, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr("cannot be used: it lacks memory"));
}

} // namespace
} // namespace stromboli::test

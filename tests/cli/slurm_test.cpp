// Pictures that a cluster with Slurm renders; the cluster is on this machine.
#include "tests/cli/program.hpp"
#include "tests/support/shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using Strings = std::vector<std::string>;

class Submit : public testing::Test {
  protected:
    ScratchFolder folder;
    std::string scene = libraryScene("cornell_boxes.dae");

    ProgramRun submit(const Strings& extra) const {
        Strings words = {"submit", "slurm", scene, "-o", folder.file("out.exr")};
        words.insert(words.end(), extra.begin(), extra.end());
        return stromboli(words);
    }
};

TEST_F(Submit, ShowsScriptsThatAShellUnderstands) {
    const ProgramRun run = submit({"--shares",  "16",
                                   "--dry-run", "-s",
                                   "64",        "--block",
                                   "4",         "-r",
                                   "40",        "30",
                                   "--seed",    "3",
                                   "--aov",     "--job-time",
                                   "2:00:00",   "--sbatch=--partition=gpu",
                                   "--sbatch",  "--gres=gpu:1",
                                   "-t",        "4",
                                   "--program", "/opt/a b/stromboli"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    for (const char* line :
         {"#SBATCH --array=1-16\n", "#SBATCH --requeue\n", "#SBATCH --time=2:00:00\n",
          "#SBATCH --partition=gpu\n", "#SBATCH --gres=gpu:1\n",
          " -r 40 30 -s 64 --seed 3 --block 4 -t 4 \\\n", "--share \"$share/16\" --expect ",
          "'/opt/a b/stromboli' merge --complete ", ".film --aov \\\n"})
        EXPECT_THAT(run.out, HasSubstr(line));
    EXPECT_EQ(run.out.find("--aov"), run.out.rfind("--aov")) << "shares know nothing of it";
    folder.write("scripts.sh", run.out);
    const ShellRun check = shell("sh -n " + folder.file("scripts.sh"));
    EXPECT_EQ(check.exitCode, 0) << check.output;
    EXPECT_EQ(folder.entries(), Strings{"scripts.sh"}); // nothing else was made
}

/// What the script runs renders, and merges, the picture of one render.
TEST_F(Submit, ScriptsRenderThePicture) {
    const Strings picture = {"-s", "8", "--block", "2", "-r", "16", "12", "-q"};
    Strings words = picture;
    words.insert(words.end(), {"--shares", "3", "--dry-run"});
    const std::string scripts = submit(words).out;
    const size_t second = scripts.find("#!/bin/sh", 1);
    folder.write("shares.sh", scripts.substr(0, second));
    folder.write("merge.sh", scripts.substr(second));
    std::filesystem::create_directory(folder.path() / "out.exr.shares");
    for (const char* share : {"2", "1", "3", "2"}) { // the last is there already
        const ShellRun task = shell(std::string("export SLURM_ARRAY_TASK_ID=") + share + "; sh " +
                                    folder.file("shares.sh"));
        EXPECT_EQ(task.exitCode, 0) << task.output;
    }
    EXPECT_EQ(shell("sh " + folder.file("merge.sh")).exitCode, 0);
    words = {"render", scene, "-o", folder.file("whole.exr"), "--even"};
    words.insert(words.end(), picture.begin(), picture.end());
    EXPECT_EQ(stromboli(words).exitCode, 0);
    const ShellRun same = shell("cmp " + folder.file("whole.exr") + " " + folder.file("out.exr"));
    EXPECT_EQ(same.exitCode, 0) << same.output;
}

TEST_F(Submit, RefusesWhatWouldFailOnTheNodes) {
    EXPECT_THAT(submit({"--shares", "5", "--dry-run", "-s", "64", "--block", "32"}).err,
                HasSubstr("3 of the 5 shares would have no samples: -s makes 2 blocks of 32"));
    EXPECT_THAT(submit({"--dry-run"}).err, HasSubstr("--shares is required"));
    const ProgramRun missing = submit({"--shares", "1", "--dry-run", "-r", "0", "3"});
    EXPECT_EQ(missing.exitCode, 1);
    // A film of another picture is in the way.
    const std::string films = folder.file("out.exr.shares");
    std::filesystem::create_directory(films);
    EXPECT_EQ(stromboli({"render", scene, "-o", films + "/part.1of1.film", "-s", "4", "-r", "8",
                         "6", "--share", "1/1"})
                  .exitCode,
              0);
    const ProgramRun other = submit({"--shares", "1", "--dry-run", "-s", "8", "-r", "8", "6"});
    EXPECT_EQ(other.exitCode, 1);
    EXPECT_THAT(other.err, HasSubstr("is of 4 samples a pixel, not of 8; remove "));
}

TEST_F(Submit, SaysThatThereIsNoSlurm) {
    if (isInstalled("sbatch")) GTEST_SKIP() << "there is";
    const ProgramRun run = submit({"--shares", "1"});
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_THAT(run.err, HasSubstr("Slurm is not installed here; --dry-run prints the scripts"));
}

/// One node dies, one is believed dead and its task lives on, and one share fails once
/// (slurm_cluster.sh): the picture has the bytes of one render, and no other share is taken twice.
TEST_F(Submit, AClusterThatLosesNodesRendersThePicture) {
    for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch"})
        if (shell(std::string("PATH=$PATH:/usr/sbin; command -v ") + program).exitCode != 0)
            GTEST_SKIP() << program << " is not installed";
    const ShellRun run = shell("PATH=$PATH:/usr/sbin timeout 240 bash " STROMBOLI_SOURCE_DIR
                               "/tests/cli/slurm_cluster.sh " STROMBOLI_PROGRAM " " +
                               libraryScene("cornell_spheres.dae") + " " + folder.path().string());
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("same bytes"));
    EXPECT_THAT(run.output, HasSubstr("each share was taken once, but for"));
    EXPECT_THAT(run.output, HasSubstr("only what is missing is submitted again"));
    EXPECT_THAT(run.output, Not(HasSubstr("FAILED")));
    EXPECT_NE(shell("grep -lzxF SLURM_CONF=" + folder.file("slurm.conf") + " /proc/[0-9]*/environ")
                  .exitCode,
              0)
        << "processes are left";
}

} // namespace
} // namespace stromboli::test

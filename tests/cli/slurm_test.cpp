// Pictures that a cluster with Slurm renders; the cluster is on this machine.
#include "host/farm/slurm_scripts.hpp"
#include "source_dir.h"
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

/// The scripts by name, as --dry-run prints them, and what follows the last one.
std::vector<std::string> scriptsIn(const std::string& text) {
    std::vector<std::string> scripts;
    for (size_t begin = text.find("#!/bin/sh"); begin != std::string::npos;) {
        const size_t end = text.find("#!/bin/sh", begin + 1);
        scripts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
        begin = end;
    }
    return scripts;
}

/// Rounds as the jobs run them, until a plan says that nothing is left: the picture has the bytes
/// of the same rounds by hand, in other shares.
TEST_F(Submit, ScriptsRenderRounds) {
    const Strings picture = {"-s", "16", "--block", "4", "-r", "16", "12", "-q"};
    Strings words = picture;
    words.insert(words.end(), {"--shares", "3", "--noise", "0.3", "--rounds", "4", "--dry-run"});
    const ProgramRun dry = submit(words);
    ASSERT_EQ(dry.exitCode, 0) << dry.err;
    const std::vector<std::string> scripts = scriptsIn(dry.out);
    ASSERT_EQ(scripts.size(), 4u);
    EXPECT_THAT(scripts[3], HasSubstr("# sbatch shares.sh\n"
                                      "# sbatch plan.sh 2\n# sbatch --array=1-3 round.sh 2\n"
                                      "# sbatch plan.sh 3\n# sbatch --array=1-3 round.sh 3\n"
                                      "# sbatch plan.sh 4\n# sbatch --array=1-3 round.sh 4\n"
                                      "# sbatch merge.sh\n"));
    for (const std::string& script : scripts)
        EXPECT_THAT(script,
                    HasSubstr("scontrol requeue \"$SLURM_JOB_ID\" && exit 0\nexit $code\n"));
    const char* const names[] = {"shares.sh", "plan.sh", "round.sh", "merge.sh"};
    for (size_t i = 0; i < 4; ++i)
        folder.write(names[i], scripts[i]);
    const std::string films = folder.file("out.exr.shares");
    std::filesystem::create_directory(films);
    const auto job = [&](const std::string& script, const std::string& task = "1") {
        const ShellRun run =
            shell("export SLURM_ARRAY_TASK_ID=" + task + "; sh " + folder.file(script));
        EXPECT_EQ(run.exitCode, 0) << run.output;
    };
    for (const char* share : {"1", "2", "3"})
        job("shares.sh", share);
    const auto jobsOf = [&](const std::string& round) {
        job("plan.sh " + round);
        for (const char* share : {"3", "1", "2", "1"}) // the last is there already
            job("round.sh " + round, share);
    };
    jobsOf("2");
    EXPECT_TRUE(std::filesystem::exists(films + "/round2.part.3of3.film"));
    // What is there is not submitted again.
    std::filesystem::remove(films + "/round2.part.2of3.film");
    const std::string again = submit(words).out;
    EXPECT_THAT(again, Not(HasSubstr("shares.sh")));
    EXPECT_THAT(again, HasSubstr("# Each after the one before:\n# sbatch --array=2 round.sh 2\n"
                                 "# sbatch plan.sh 3\n"));
    job("round.sh 2", "2");
    jobsOf("3");
    jobsOf("4");
    const bool isOver = !std::filesystem::exists(films + "/round4.plan");
    EXPECT_EQ(isOver, !std::filesystem::exists(films + "/round4.part.1of3.film"));
    EXPECT_TRUE(isOver) << "the noise should be reached in three rounds";
    job("merge.sh");

    // Done by hand.
    const auto stage = [&](const Strings& extra) {
        Strings all = {"render", scene};
        all.insert(all.end(), picture.begin(), picture.end());
        all.insert(all.end(), extra.begin(), extra.end());
        EXPECT_EQ(stromboli(all).exitCode, 0);
    };
    Strings hand = {folder.file("1.film")};
    stage({"--share", "1/1", "-o", hand[0]});
    for (int round = 2;; ++round) {
        const std::string plan = folder.file(std::to_string(round) + ".plan");
        Strings all = {"plan", "--noise", "0.3", "-o", plan};
        all.insert(all.end(), hand.begin(), hand.end());
        const int code = stromboli(all).exitCode;
        if (code == 7) break;
        ASSERT_EQ(code, 0);
        hand.push_back(folder.file(std::to_string(round) + ".film"));
        stage({"--share", "1/1", "--plan", plan, "-o", hand.back()});
    }
    Strings all = {"merge", "-o", folder.file("whole.exr")};
    all.insert(all.end(), hand.begin(), hand.end());
    EXPECT_EQ(stromboli(all).exitCode, 0);
    const ShellRun same = shell("cmp " + folder.file("whole.exr") + " " + folder.file("out.exr"));
    EXPECT_EQ(same.exitCode, 0) << same.output;
}

/// A job whose program fails goes back into the queue and is no failure, so that the jobs after it
/// are not cancelled, but for the last time.
TEST_F(Submit, JobsThatFailAreTriedAgain) {
    const std::vector<std::string> scripts =
        scriptsIn(submit({"--shares", "2", "--noise", "0.3", "--rounds", "2", "--dry-run", "-s",
                          "8", "--block", "4", "--program", "/bin/false"})
                      .out);
    ASSERT_EQ(scripts.size(), 4u);
    const std::string films = folder.file("out.exr.shares");
    std::filesystem::create_directory(films);
    folder.write("scontrol", "#!/bin/sh\necho \"$@\" >>" + folder.file("said"));
    std::filesystem::permissions(folder.file("scontrol"), std::filesystem::perms::owner_all);
    const auto codeAfter = [&](int restarts) {
        return shell("cd " + folder.path().string() +
                     "; PATH=.:$PATH SLURM_RESTART_COUNT=" + std::to_string(restarts) +
                     " SLURM_JOB_ID=42 SLURM_ARRAY_TASK_ID=1 sh job.sh 2")
            .exitCode;
    };
    for (size_t i = 0; i < scripts.size(); ++i) {
        folder.write("job.sh", scripts[i]);
        if (i == 2) folder.write("out.exr.shares/round2.plan", "");
        std::filesystem::remove(folder.file("said"));
        EXPECT_EQ(codeAfter(0), 0) << scripts[i];
        EXPECT_EQ(codeAfter(2), 0) << scripts[i];
        EXPECT_EQ(shell("cat " + folder.file("said")).output, "requeue 42\nrequeue 42\n");
        EXPECT_EQ(codeAfter(3), 1) << scripts[i];
    }
}

/// Groups of many shares are merged first, each by a job; the folder has a space in its name.
/// On the reference, which starts sooner: who takes the shares is nothing to how they are merged.
TEST_F(Submit, ManySharesAreMergedInGroups) {
    const std::string output = folder.file("a b.exr");
    const Strings picture = {"-s", "65", "--block", "1",         "-r",
                             "4",  "3",  "-q",      "--backend", "reference"};
    Strings words = {"submit", "slurm", scene, "-o", output, "--shares", "65", "--dry-run"};
    words.insert(words.end(), picture.begin(), picture.end());
    const std::vector<std::string> scripts = scriptsIn(stromboli(words).out);
    ASSERT_EQ(scripts.size(), 3u);
    EXPECT_THAT(scripts[1], HasSubstr("#SBATCH --array=1-3\n"));
    EXPECT_THAT(scripts[1], HasSubstr("scontrol requeue"));
    const char* const names[] = {"shares.sh", "groups.sh", "merge.sh"};
    for (size_t i = 0; i < 3; ++i)
        folder.write(names[i], scripts[i]);
    std::filesystem::create_directory(output + ".shares");
    const ShellRun run = shell("cd " + folder.path().string() +
                               "; set -e; for i in $(seq 65); do SLURM_ARRAY_TASK_ID=$i sh "
                               "shares.sh; done; for i in 1 2 3; do SLURM_ARRAY_TASK_ID=$i sh "
                               "groups.sh; done; sh merge.sh");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    words = {"render", scene, "-o", folder.file("whole.exr"), "--even"};
    words.insert(words.end(), picture.begin(), picture.end());
    EXPECT_EQ(stromboli(words).exitCode, 0);
    const ShellRun same = shell("cmp " + folder.file("whole.exr") + " '" + output + "'");
    EXPECT_EQ(same.exitCode, 0) << same.output;
}

TEST(FrameArrays, StayBelowTheMostTasksOfSlurm) {
    const std::vector<FrameArray> arrays = arraysOf({0, 1, 999, 1000, 1003, 2500});
    ASSERT_EQ(arrays.size(), 3u);
    EXPECT_EQ(arrays[0].first, 0u);
    EXPECT_EQ(arrayOf(arrays[0].tasks), "0-1,999");
    EXPECT_EQ(arrays[1].first, 1000u);
    EXPECT_EQ(arrayOf(arrays[1].tasks), "0,3");
    EXPECT_EQ(arrays[2].first, 2000u);
    EXPECT_EQ(arrayOf(arrays[2].tasks), "500");
}

/// Frames as the tasks render them, with the bytes of one command for all.
TEST_F(Submit, ScriptsRenderFrames) {
    const Strings picture = {"-s", "8", "-r", "16", "12", "--turntable", "4", "-q", "--aov"};
    const std::string output = folder.file("f%02d.exr");
    Strings words = {"submit", "slurm", scene, "-o", output, "--frames", "1..3", "--dry-run"};
    words.insert(words.end(), picture.begin(), picture.end());
    const ProgramRun dry = stromboli(words);
    ASSERT_EQ(dry.exitCode, 0) << dry.err;
    EXPECT_THAT(dry.out, HasSubstr("# sbatch --array=1-3 frames.sh 0\n"));
    EXPECT_THAT(dry.out, HasSubstr("--output=" + folder.file("f.exr.frames") + "/frame.%A_%a.log"));
    folder.write("frames.sh", dry.out);
    EXPECT_EQ(shell("sh -n " + folder.file("frames.sh")).exitCode, 0);
    const auto task = [&](const std::string& number) {
        const ShellRun run = shell("export SLURM_ARRAY_TASK_ID=" + number + "; sh " +
                                   folder.file("frames.sh") + " 0");
        EXPECT_EQ(run.exitCode, 0) << run.output;
    };
    for (const char* number : {"3", "1", "2", "1"}) // the last is there already
        task(number);
    Strings together = {"render", scene, "-o", folder.file("w%02d.exr"), "--frames", "1..3"};
    together.insert(together.end(), picture.begin(), picture.end());
    ASSERT_EQ(stromboli(together).exitCode, 0);
    for (const char* frame : {"01", "02", "03"}) {
        const ShellRun same = shell(std::string("cmp ") + folder.file("w") + frame + ".exr " +
                                    folder.file("f") + frame + ".exr");
        EXPECT_EQ(same.exitCode, 0) << same.output;
    }
    // What is there is not submitted again; what has begun is.
    std::filesystem::remove(folder.file("f02.exr"));
    folder.write("f03.exr.checkpoint", "");
    EXPECT_THAT(stromboli(words).out, HasSubstr("# sbatch --array=2-3 frames.sh 0\n"));
}

/// Each frame as a picture in shares.
TEST_F(Submit, ScriptsRenderSharesOfFrames) {
    const Strings picture = {"-s", "8", "--block", "2", "-r", "16", "12", "--turntable", "3", "-q"};
    Strings words = {"submit",   "slurm", scene,      "-o",   folder.file("f.exr"),
                     "--shares", "2",     "--frames", "1..2", "--dry-run"};
    words.insert(words.end(), picture.begin(), picture.end());
    const ProgramRun dry = stromboli(words);
    ASSERT_EQ(dry.exitCode, 0) << dry.err;
    const std::vector<std::string> scripts = scriptsIn(dry.out);
    ASSERT_EQ(scripts.size(), 4u);
    for (const char* frame : {"0001", "0002"})
        std::filesystem::create_directory(folder.file(std::string("f.") + frame + ".exr.shares"));
    for (size_t i = 0; i < 4; ++i) {
        folder.write("job.sh", scripts[i]);
        for (const char* share : {"2", "1"}) {
            const ShellRun run = shell(std::string("export SLURM_ARRAY_TASK_ID=") + share +
                                       "; sh " + folder.file("job.sh"));
            EXPECT_EQ(run.exitCode, 0) << run.output;
        }
    }
    Strings together = {"render", scene, "-o", folder.file("w.exr"), "--frames", "1..2", "--even"};
    together.insert(together.end(), picture.begin(), picture.end());
    ASSERT_EQ(stromboli(together).exitCode, 0);
    for (const char* frame : {"0001", "0002"}) {
        const ShellRun same = shell(std::string("cmp ") + folder.file("w.") + frame + ".exr " +
                                    folder.file("f.") + frame + ".exr");
        EXPECT_EQ(same.exitCode, 0) << same.output;
    }
}

TEST_F(Submit, RefusesWhatWouldFailOnTheNodes) {
    EXPECT_THAT(submit({"--turntable", "4", "--block", "2", "--dry-run"}).err,
                HasSubstr("--block: only with --shares"));
    EXPECT_THAT(submit({"--turntable", "4", "--frames", "2..4", "--dry-run"}).err,
                HasSubstr("0 to 3"));
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
    EXPECT_THAT(other.err, HasSubstr("is of 4 samples a pixel, not of 8 (-s); remove "));
}

TEST_F(Submit, SaysThatThereIsNoSlurm) {
    if (isInstalled("sbatch")) GTEST_SKIP() << "there is";
    const ProgramRun run = submit({"--shares", "1"});
    EXPECT_EQ(run.exitCode, 1);
    EXPECT_THAT(run.err, HasSubstr("Slurm is not installed here; --dry-run prints the scripts"));
}

/// One node dies, one is believed dead and its task lives on, and one share fails once
/// (slurm_cluster.sh): the picture has the bytes of one render, and no other share is taken twice.
/// Another one in rounds has the bytes of the same rounds without a cluster.
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
    EXPECT_THAT(run.output, HasSubstr("rounds have the bytes of rounds by hand"));
    EXPECT_THAT(run.output, HasSubstr("each frame was rendered once, but for"));
    EXPECT_THAT(run.output, Not(HasSubstr("FAILED")));
    EXPECT_NE(shell("grep -lzxF SLURM_CONF=" + folder.file("slurm.conf") + " /proc/[0-9]*/environ")
                  .exitCode,
              0)
        << "processes are left";
}

} // namespace
} // namespace stromboli::test

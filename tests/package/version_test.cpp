// The version of a source folder, as cmake/GitVersion.cmake says it.
#include "source_dir.h"
#include "tests/support/shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace stromboli::test {
namespace {

/// A source folder with one file, and git without the user's settings.
class Version : public testing::Test {
  protected:
    void SetUp() override {
        if (!isInstalled("git")) GTEST_SKIP() << "git is not installed";
        run("mkdir source && cd source && echo 1 >file");
        std::ofstream(folder_ / "version.in") << "@version@";
    }
    std::string run(const std::string& commands) {
        const ShellRun done =
            shell("set -e; cd " + folder_.path().string() +
                  "; export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null\n"
                  "git() { command git -c user.name=a -c user.email=a@b -c init.defaultBranch=main "
                  "\"$@\"; }\n" +
                  commands);
        EXPECT_EQ(done.exitCode, 0) << done.output;
        return done.output;
    }
    /// Version of the folder, as the build asks for it.
    std::string version() {
        return run("cmake -DSOURCE=$PWD/source -DBASE=0.1.0 -DINPUT=version.in -DOUTPUT=version "
                   "-P " STROMBOLI_SOURCE_DIR "/cmake/GitVersion.cmake; printf %s $(cat version)");
    }
    /// ".gabcdef1" of the last commit.
    std::string commit() { return ".g" + run("cd source; git rev-parse HEAD").substr(0, 7); }
    void commitFile() { run("cd source; git add file; git commit -qm message"); }

    EmptyFolder folder_;
};

TEST_F(Version, OfAnUnpackedArchiveIsTheProjects) {
    EXPECT_EQ(version(), "0.1.0");
    run("git init -q"); // around it: of another project
    run("git add source; git commit -qm message");
    EXPECT_EQ(version(), "0.1.0");
}

TEST_F(Version, OfACheckoutCountsCommitsAndNamesTheLast) {
    run("cd source; git init -q");
    EXPECT_EQ(version(), "0.1.0") << "no commit yet";
    commitFile();
    EXPECT_EQ(version(), "0.1.0+1" + commit());
    run("echo 2 >source/file");
    EXPECT_EQ(version(), "0.1.0+1" + commit() + ".changed");
    commitFile();
    EXPECT_EQ(version(), "0.1.0+2" + commit());
    run("echo 3 >source/another");
    EXPECT_EQ(version(), "0.1.0+2" + commit()) << "a file that git does not know";
}

TEST_F(Version, CommitsCountFromTheTagOfTheVersion) {
    run("cd source; git init -q");
    commitFile();
    run("cd source; git tag v0.0.9");
    EXPECT_EQ(version(), "0.1.0+1" + commit());
    run("cd source; git tag -a v0.1.0 -m release");
    EXPECT_EQ(version(), "0.1.0");
    run("echo 2 >source/file");
    EXPECT_EQ(version(), "0.1.0+changed");
    commitFile();
    EXPECT_EQ(version(), "0.1.0+1" + commit());
}

TEST_F(Version, AFileIsWrittenOnlyWhereItChanges) {
    run("cd source; git init -q");
    commitFile();
    version();
    run("touch -d 2001-01-01 version version.in");
    version();
    EXPECT_EQ(run("stat -c %y version").substr(0, 4), "2001");
    run("echo 2 >source/file");
    commitFile();
    version();
    EXPECT_NE(run("stat -c %y version").substr(0, 4), "2001");
}

TEST_F(Version, IsInStatisticsAsTheProgramSaysIt) {
    const std::string said = run(STROMBOLI_PROGRAM " --version");
    ASSERT_THAT(said, testing::MatchesRegex("stromboli [0-9]+\\.[0-9]+\\.[0-9]+(\\+.*)?\n"));
    const std::string version = said.substr(10, said.size() - 11);
    EXPECT_TRUE(version.starts_with(STROMBOLI_PROJECT_VERSION)) << version;
    EXPECT_THAT(run(STROMBOLI_PROGRAM " render generate:lamps:8 -r 4 4 -s 1 --backend reference -q "
                                      "-o a.png --stats -"),
                testing::HasSubstr("\"version\": \"" + version + "\""));
}

/// What a checkpoint tells builds apart by.
TEST_F(Version, TheRenderingCodeIsThatOfTheRenderers) {
    const auto code = [&](const std::string& tools) {
        return run("printf @rendering_code@ >code.in; cmake -DSOURCE=$PWD/source -DBASE=0.1.0 "
                   "-DTOOLS='" +
                   tools +
                   "' -DINPUT=code.in -DOUTPUT=code -P " STROMBOLI_SOURCE_DIR
                   "/cmake/GitVersion.cmake; printf %s $(cat code)");
    };
    run("mkdir -p source/shaders/lights source/host/cli source/docs; cd source; echo 1 "
        ">shaders/lights/a.glsl; echo 1 >host/cli/b.cpp; echo 1 >docs/c.txt; echo 1 >shaders/d.md");
    const std::string first = code("g++ 12");
    EXPECT_EQ(first.size(), 16u);
    EXPECT_EQ(first.find_first_not_of("0123456789abcdef"), std::string::npos);
    run("cd source; echo 2 >host/cli/b.cpp; echo 2 >docs/c.txt; echo 2 >shaders/d.md");
    EXPECT_EQ(code("g++ 12"), first) << "nothing that renders";
    EXPECT_NE(code("g++ 13"), first);
    run("cd source; echo 2 >shaders/lights/a.glsl");
    const std::string second = code("g++ 12");
    EXPECT_NE(second, first);
    run("cd source; mv shaders/lights/a.glsl shaders/lights/b.glsl");
    EXPECT_NE(code("g++ 12"), second);
}

} // namespace
} // namespace stromboli::test

// Manual page and completion hold what is declared, and the programs that read them understand
// them.
#include "host/cli/declared_command.hpp"
#include "host/manual/manual.hpp"
#include "source_dir.h"
#include "tests/support/shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;

std::string replaceAll(std::string text, const std::string& what, const std::string& by) {
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

/// The page as a reader sees it, on lines as long as the source has.
std::string readManual() {
    std::string text = manPage();
    for (const auto& [code, character] : {std::pair{"\\fB", ""},
                                          {"\\fI", ""},
                                          {"\\fR", ""},
                                          {"\\-", "-"},
                                          {"\\(aq", "'"},
                                          {"\\(ga", "`"},
                                          {"\\(ha", "^"},
                                          {"\\(ti", "~"},
                                          {"\\(dq", "\""},
                                          {"\\&", ""}})
        text = replaceAll(text, code, character);
    return text;
}

/// What the page says of a command.
std::string partOf(const std::string& page, const std::string& command) {
    const size_t begin = page.find("\n.SS " + command + "\n");
    EXPECT_NE(begin, std::string::npos) << command;
    return page.substr(
        begin, std::min(page.find("\n.SS ", begin + 1), page.find("\n.SH ", begin + 1)) - begin);
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

/// What bash proposes for the last word of a command line.
std::vector<std::string> completed(const std::vector<std::string>& words,
                                   const std::string& before = "") {
    std::string script = before + "\n" + bashCompletion() + "\nCOMP_WORDS=(stromboli";
    for (const std::string& word : words)
        script += " '" + word + "'";
    script += ")\nCOMP_CWORD=" + std::to_string(words.size()) +
              "\n_stromboli\nprintf '%s\\n' \"${COMPREPLY[@]}\"";
    std::vector<std::string> lines = linesOf(shell(script).output);
    if (lines == std::vector<std::string>{""}) lines.clear();
    return lines;
}

TEST(Manual, HasEveryCommandAndOption) {
    const std::string page = readManual();
    for (const DeclaredCommand& c : declareCommands()) {
        const std::string part = partOf(page, c.name);
        EXPECT_THAT(part, HasSubstr(c.description));
        for (const CommandOption& o : c.list.all()) {
            if (o.isHidden) {
                EXPECT_THAT(part, Not(HasSubstr(o.name()))) << c.name;
                continue;
            }
            const std::string names = replaceAll(o.names, ",", ", ");
            const std::string term = o.valueNames.empty() ? names : names + " " + o.valueNames;
            EXPECT_THAT(part, testing::AnyOf(HasSubstr("\n.TP\n" + term + "\n" + o.help),
                                             HasSubstr("\n.TP\n" + term + "...\n" + o.help)))
                << c.name;
            EXPECT_THAT(part, HasSubstr(o.range));
            EXPECT_THAT(part, HasSubstr(o.usual));
        }
    }
}

TEST(Manual, HasEveryEnvironmentVariableThatIsRead) {
    const std::string page = readManual();
    const ShellRun found =
        shell("grep -rhoE 'getenv\\(\"[A-Z_]+' " STROMBOLI_SOURCE_DIR "/host " STROMBOLI_SOURCE_DIR
              "/scene --include=*.cpp | sed 's/.*\"//' | sort -u");
    const std::vector<std::string> names = linesOf(found.output);
    EXPECT_GE(names.size(), 4u);
    for (const std::string& name : names)
        EXPECT_THAT(page.substr(page.find(".SH ENVIRONMENT")), HasSubstr(name));
}

TEST(Manual, FormattersFindNothingWrong) {
    const EmptyFolder folder;
    std::ofstream(folder / "stromboli.1") << manPage();
    for (const std::string formatter : {"man --warnings -l", "groff -man -ww -Tutf8"}) {
        if (!isInstalled(formatter.substr(0, formatter.find(' ')))) GTEST_SKIP() << formatter;
        const ShellRun run = shell("LC_ALL=C.UTF-8 MANWIDTH=80 " + formatter + " " +
                                   (folder / "stromboli.1") + " 2>&1 >/dev/null");
        EXPECT_EQ(run.exitCode, 0) << formatter;
        EXPECT_EQ(run.output, "") << formatter;
    }
}

TEST(Manual, OptionsThatTakeAKnownSetOfWordsProposeThem) {
    // A new option of such a kind is not to be forgotten: its words stand in its help.
    for (const DeclaredCommand& c : declareCommands())
        for (const CommandOption& o : c.list.all())
            if (o.help.starts_with("on: ")) {
                EXPECT_EQ(o.proposals, (Words{"on", "off"})) << c.name << " " << o.name();
            } else if (o.valueNames.starts_with("FILE")) {
                EXPECT_EQ(o.proposed, Proposed::Files) << c.name << " " << o.name();
            }
}

TEST(Completion, ProposalsAreSingleWords) {
    for (const DeclaredCommand& c : declareCommands())
        for (const CommandOption& o : c.list.all())
            for (const std::string& word : o.proposals)
                EXPECT_THAT(word, testing::MatchesRegex("[a-zA-Z0-9_.-]+")) << c.name << o.name();
}

TEST(Completion, BashUnderstandsIt) {
    const EmptyFolder folder;
    std::ofstream(folder / "completion") << bashCompletion();
    const ShellRun run = shell("bash -n " + (folder / "completion"));
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_EQ(run.output, "");
}

TEST(Completion, OffersEveryCommand) {
    std::vector<std::string> names;
    for (const DeclaredCommand& c : declareCommands())
        names.push_back(c.name);
    EXPECT_THAT(completed({""}), IsSupersetOf(names));
    EXPECT_THAT(completed({"co"}), ElementsAre("compare"));
    EXPECT_THAT(completed({"--v"}), ElementsAre("--version"));
}

TEST(Completion, OffersTheOptionsOfACommandAndNoOthers) {
    for (const DeclaredCommand& c : declareCommands()) {
        std::set<std::string> expected = {"-h", "--help"};
        for (const CommandOption& o : c.list.all()) {
            std::istringstream names(o.names);
            for (std::string name; std::getline(names, name, ',');)
                if (!o.isHidden && name.starts_with("-")) expected.insert(name);
        }
        const std::vector<std::string> offered = completed({c.name, "-"});
        EXPECT_EQ(std::set<std::string>(offered.begin(), offered.end()), expected) << c.name;
    }
}

TEST(Completion, OffersTheWordsOfAnOption) {
    EXPECT_THAT(completed({"render", "a.dae", "--direct", ""}),
                ElementsAre("mis", "mis-all", "lights", "hemisphere", "bsdf"));
    EXPECT_THAT(completed({"render", "a.dae", "--direct=h"}), ElementsAre("hemisphere"));
    EXPECT_THAT(completed({"render", "--strict", "--gap-proposal", "o"}), ElementsAre("on", "off"));
    EXPECT_THAT(completed({"bench", "--only", "rays,p"}), ElementsAre("rays,paths"));
    EXPECT_THAT(completed({"study", "-c", "hem"}), ElementsAre("hemisphere"));
    EXPECT_THAT(completed({"stress", "edges", "white-"}), IsEmpty());
}

TEST(Completion, KnowsHowManyWordsAnOptionTakes) {
    EXPECT_THAT(completed({"render", "-r", "20", ""}), IsEmpty()) << "a number";
    EXPECT_THAT(completed({"render", "-r", "20", "10", "--ev"}), ElementsAre("--even"));
    EXPECT_THAT(completed({"render", "-r", "20", "10", "orth"}), ElementsAre("ortho"));
    EXPECT_THAT(completed({"render", "--exposure", "-1", "--ev"}), ElementsAre("--even"));
    EXPECT_THAT(completed({"render", "ortho", "orth"}), IsEmpty()) << "one scene";
    EXPECT_THAT(completed({"bench", "ortho", "orth"}), ElementsAre("ortho")) << "several scenes";
}

TEST(Completion, OffersScenesAndFiles) {
    const EmptyFolder folder;
    const std::string inside =
        "cd " + folder.path().string() + "; touch 'light room.dae' light.png; mkdir -p lightness";
    EXPECT_THAT(completed({"check", "light_s"}), ElementsAre("light_sphere", "light_spot"));
    EXPECT_THAT(completed({"check", "light"}, inside),
                IsSupersetOf({"light_point", "light room.dae", "light.png"}));
    EXPECT_THAT(completed({"compare", "light.png", "light r"}, inside),
                ElementsAre("light room.dae"));
    EXPECT_THAT(completed({"study", "-o", "l"}, inside), ElementsAre("lightness"));
}

TEST(Completion, WorksWithBashCompletion) {
    const std::string library = "/usr/share/bash-completion/bash_completion";
    if (!std::filesystem::exists(library)) GTEST_SKIP() << "bash-completion is not installed";
    // There bash hands over words that end at = and :.
    const std::string load =
        "shopt -s extglob; COMP_LINE='stromboli X' COMP_POINT=100; . " + library;
    const auto withLine = [&](const std::string& line, const std::vector<std::string>& words) {
        return completed(words, load + "\nCOMP_LINE='" + line + "' COMP_POINT=${#COMP_LINE}");
    };
    EXPECT_THAT(withLine("stromboli render a --direct=h", {"render", "a", "--direct", "=", "h"}),
                ElementsAre("hemisphere"));
    EXPECT_THAT(withLine("stromboli render generate:corn", {"render", "generate", ":", "corn"}),
                ElementsAre("cornell_mesh:"));
}

TEST(Completion, OfFishOffersCommandsOptionsAndWords) {
    if (!isInstalled("fish")) GTEST_SKIP() << "fish is not installed";
    const EmptyFolder folder;
    std::ofstream(folder / "stromboli.fish") << fishCompletion();
    std::ofstream(folder / "one.dae") << "";
    const auto offered = [&](const std::string& line) {
        const ShellRun run =
            shell("cd " + folder.path().string() + "; export HOME=$PWD; fish -N -c '" +
                  "source stromboli.fish; complete -C \"stromboli " + line + "\"'");
        std::set<std::string> names; // what each means stands behind a tab
        for (const std::string& one : linesOf(run.output))
            names.insert(one.substr(0, one.find('\t')));
        return names;
    };
    for (const DeclaredCommand& c : declareCommands()) {
        EXPECT_TRUE(offered("").contains(c.name));
        std::set<std::string> expected = {"-h", "--help"};
        for (const CommandOption& o : c.list.all()) {
            const Words names = o.dashedNames();
            if (!o.isHidden) expected.insert(names.begin(), names.end());
        }
        EXPECT_EQ(offered(c.name + " -"), expected);
    }
    using Names = std::set<std::string>;
    EXPECT_EQ(offered("render a --direct h"), Names{"hemisphere"});
    EXPECT_EQ(offered("render ortho --gap-proposal "), (Names{"on", "off"}));
    EXPECT_EQ(offered("render o"), (Names{"ortho", "one.dae"}));
    EXPECT_EQ(offered("render --stats o"), Names{"one.dae"});
    EXPECT_EQ(offered("render --seed o"), Names{});
}

TEST(Completion, OfZshHandsOverEveryOptionOfACommand) {
    if (!isInstalled("zsh")) GTEST_SKIP() << "zsh is not installed";
    const EmptyFolder folder;
    std::ofstream(folder / "_stromboli") << zshCompletion();
    // Functions of zsh that say what they are asked for, in the place of those that complete.
    const auto asked = [&](const std::string& words, int current) {
        std::ofstream(folder / "ask") << "compdef() { }\n"
                                         "compadd() { print -rl -- ${@[2,-1]} }\n"
                                         "_describe() { print -rl -- ${(P)2} }\n"
                                         "_arguments() { print -rl -- \"$@\" }\n"
                                         "source " +
                                             (folder / "_stromboli") + "\nwords=(" + words +
                                             ") CURRENT=" + std::to_string(current) +
                                             "\n_stromboli\n";
        return shell("zsh -f " + (folder / "ask")).output;
    };
    // Names that it excludes, its name, [what it means], :words; the meaning ends at the first ]
    // that has no backslash.
    const std::regex optionLine(
        "(?:\\([^)]*\\)|\\*)(-[^=\\[]+)=?\\[((?:\\\\.|[^\\]\\\\])*)\\](.*)");
    struct Spec {
        std::string meaning, words;
    };
    for (const DeclaredCommand& c : declareCommands()) {
        EXPECT_THAT(asked("stromboli ''", 2),
                    HasSubstr(c.name + ":" + replaceAll(c.description, ":", "\\:")));
        std::map<std::string, Spec> specs; // by the option's name
        for (const std::string& line : linesOf(asked("stromboli " + c.name + " ''", 3)))
            if (std::smatch parts; std::regex_match(line, parts, optionLine))
                specs[parts[1]] = {parts[2], parts[3]};
        size_t names = 2; // -h and --help
        for (const CommandOption& o : c.list.all())
            for (const std::string& name : o.dashedNames()) {
                EXPECT_EQ(specs.contains(name), !o.isHidden) << c.name << " " << name;
                if (o.isHidden) continue;
                ++names;
                const Spec spec = specs[name];
                EXPECT_EQ(replaceAll(replaceAll(spec.meaning, "\\[", "["), "\\]", "]"),
                          o.fullHelp());
                EXPECT_EQ(std::count(spec.words.begin(), spec.words.end(), ':'), 2 * o.wordCount)
                    << spec.words;
            }
        EXPECT_EQ(specs.size(), names) << c.name;
    }
    EXPECT_THAT(asked("stromboli render a --direct ''", 5),
                HasSubstr(":HOW:{compadd -- mis mis-all lights hemisphere bsdf}"));
}

} // namespace
} // namespace stromboli::test

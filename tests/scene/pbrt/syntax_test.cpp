// The text of scenes: words, directives, parameters, files inside of files, versions.

#include "scene/pbrt/statement_reader.hpp"
#include "scene/pbrt/tokens.hpp"
#include "scene/pbrt/version.hpp"
#include "scene/read_scene.hpp"
#include "tests/scene/pbrt/pbrt_text.hpp"

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<pbrt::Statement> statementsOf(const std::string& text, build::Report& report) {
    const std::filesystem::path file = writeFile("statements.pbrt", text);
    const pbrt::Files files(file, report);
    return pbrt::StatementReader(files, report).read(file);
}

std::vector<pbrt::Statement> statementsOf(const std::string& text) {
    build::Report report;
    return statementsOf(text, report);
}

/// What strict reading says; the file's name is left out.
std::string syntaxProblem(const std::string& text) {
    build::Report report(true);
    try {
        statementsOf(text, report);
    } catch (const SceneError& error) {
        const std::string message = error.what();
        return message.substr(message.find(".pbrt:") + 6);
    }
    return "";
}

TEST(PbrtTokens, AreWordsStringsAndBrackets) {
    pbrt::Tokens tokens("Scale 1 # \"comment\n[ -2.5e3 ] \"a b\"[\"c\" \"open\n]");
    tokens.begin();
    std::vector<std::string> words;
    std::vector<int> lines;
    while (tokens.peek().kind != pbrt::Token::Kind::End) {
        const pbrt::Token token = tokens.take();
        words.emplace_back(token.text);
        lines.push_back(token.line);
        EXPECT_EQ(token.isCutOff, token.text == "open");
    }
    EXPECT_THAT(words, ElementsAre("Scale", "1", "[", "-2.5e3", "]", "a b", "[", "c", "open", "]"));
    EXPECT_THAT(lines, ElementsAre(1, 1, 2, 2, 2, 2, 2, 2, 2, 3));
}

TEST(PbrtSyntax, DirectivesHaveTheirArguments) {
    const auto s = statementsOf("LookAt 1 2 3 4 5 6 7 8 9\nTransform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 "
                                "0 1]\nActiveTransform StartTime MediumInterface \"gas\"\n"
                                "Texture \"a\" \"float\" \"constant\" \"float value\" 0.5");
    ASSERT_EQ(s.size(), 5u);
    EXPECT_EQ(s[0].directive(), "LookAt");
    EXPECT_THAT(s[0].numbers, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
    EXPECT_EQ(s[1].numbers.size(), 16u);
    EXPECT_THAT(s[2].words, ElementsAre("StartTime"));
    EXPECT_THAT(s[3].words, ElementsAre("gas"));
    EXPECT_THAT(s[4].words, ElementsAre("a", "float", "constant"));
    EXPECT_EQ(s[4].place.line, 4);
}

TEST(PbrtSyntax, ParametersHaveTypesNamesAndValues) {
    const auto s = statementsOf("Shape \"sphere\"\n \"float  radius\" 2 \"bool a\" true\n"
                                "\"bool b\" [\"false\"] \"string c\" [\"x\" \"y\"] \"rgb d\" [1 .5 "
                                "+2]");
    ASSERT_EQ(s.size(), 1u);
    const std::vector<pbrt::Parameter>& p = s[0].parameters;
    ASSERT_EQ(p.size(), 5u);
    EXPECT_EQ(p[0].type, "float");
    EXPECT_EQ(p[0].name, "radius");
    EXPECT_EQ(p[0].line, 2);
    EXPECT_THAT(p[0].numbers, ElementsAre(2));
    EXPECT_THAT(p[1].words, ElementsAre("true"));
    EXPECT_THAT(p[2].words, ElementsAre("false"));
    EXPECT_THAT(p[3].words, ElementsAre("x", "y"));
    EXPECT_THAT(p[4].numbers, ElementsAre(1, 0.5, 2));
}

TEST(PbrtSyntax, ErrorsNamePlaceAndWhatWasExpected) {
    EXPECT_EQ(syntaxProblem("\nRotate 1 2 x 4\n"),
              "2: <Rotate>: has 'x', expected 4 numbers (an error because of --strict)");
    EXPECT_THAT(syntaxProblem("Sphere 1"), HasSubstr("1: 'Sphere' is no directive"));
    EXPECT_THAT(syntaxProblem("Shape sphere"), HasSubstr("1: <Shape>: has 'sphere', expected a "
                                                         "name in quotes"));
    EXPECT_THAT(syntaxProblem("Shape \"sphere\" \"radius\" 1"),
                HasSubstr("expected the type and the name of a parameter"));
    EXPECT_THAT(syntaxProblem("Shape \"sphere\"\n\"float radius\" x"),
                HasSubstr("2: <Shape>: 'radius' has the value 'x'"));
    EXPECT_THAT(syntaxProblem("Shape \"sphere\" \"float radius\" [1"), HasSubstr("has no ']'"));
    EXPECT_THAT(syntaxProblem("Transform [1 2 3]"), HasSubstr("expected 16 numbers"));
    EXPECT_THAT(syntaxProblem("Include \"nowhere.pbrt\""), HasSubstr("which is not there"));
}

TEST(PbrtSyntax, AWrongStatementCostsItselfAlone) {
    build::Report report;
    const auto s = statementsOf("Identity Rotate 1 2 x 4 5 \"a\" [ Identity", report);
    EXPECT_EQ(s.size(), 2u);
}

TEST(PbrtSyntax, FilesAreIncluded) {
    writeFile("inside/part.pbrt", "Translate 1 2 3\nInclude \"inside/more.pbrt\"\n");
    writeFile("inside/more.pbrt", "Scale 1 2 3\n");
    const auto s = statementsOf("Include \"inside/part.pbrt\" Import \"more.pbrt\" Identity");
    ASSERT_EQ(s.size(), 4u - 1u);
    EXPECT_EQ(s[0].directive(), "Translate");
    EXPECT_THAT(s[0].place.file, HasSubstr("part.pbrt"));
    EXPECT_EQ(s[1].directive(), "Scale");
    EXPECT_EQ(s[2].directive(), "Identity");
}

TEST(PbrtSyntax, FilesThatIncludeThemselvesEnd) {
    build::Report report;
    writeFile("statements.pbrt", "");
    const auto s = statementsOf("Identity Include \"statements.pbrt\"", report);
    ASSERT_EQ(s.size(), 1u) << "which is there once";
    ASSERT_NE(report.firstError(), nullptr);
    EXPECT_THAT(syntaxProblem("Include \"statements.pbrt\""), HasSubstr("include itself"));
}

TEST(PbrtSyntax, FilesMayBePackedByGzip) {
    const std::string packed = gzip("Translate 1 2 3 ");
    writeFile("packed.pbrt.gz", packed);
    EXPECT_EQ(statementsOf("Include \"packed.pbrt.gz\"").size(), 1u);
    writeFile("packed.pbrt.gz", packed.substr(0, packed.size() / 2));
    EXPECT_THAT(syntaxProblem("Include \"packed.pbrt.gz\""), HasSubstr("damaged"));
}

/// Editors of Windows mark a text, or write it in UTF-16.
TEST(PbrtSyntax, FilesMayBeMarkedOrInUtf16) {
    for (const std::string& text : {std::string("\xEF\xBB\xBFTranslate 1 2 3 "),
                                    std::string("\xFF\xFEI\0d\0e\0n\0t\0i\0t\0y\0", 18)}) {
        writeFile("marked.pbrt", text);
        EXPECT_EQ(statementsOf("Include \"marked.pbrt\"").size(), 1u);
    }
    writeFile("marked.pbrt", "\xFF\xFEI");
    EXPECT_THAT(syntaxProblem("Include \"marked.pbrt\""),
                HasSubstr("begins as UTF-16, but is none"));
}

pbrt::Version versionOf(const std::string& text) {
    return pbrt::versionOf(statementsOf(text)).version;
}

TEST(PbrtVersion, IsToldByWhatAFileUses) {
    using enum pbrt::Version;
    EXPECT_EQ(versionOf("Material \"matte\""), V3);
    EXPECT_EQ(versionOf("Material \"diffuse\""), V4);
    EXPECT_EQ(versionOf("MakeNamedMaterial \"a\" \"string type\" \"uber\""), V3);
    EXPECT_EQ(versionOf("MakeNamedMaterial \"a\" \"string type\" \"conductor\""), V4);
    EXPECT_EQ(versionOf("WorldBegin WorldEnd"), V3);
    EXPECT_EQ(versionOf("Film \"image\""), V3);
    EXPECT_EQ(versionOf("Film \"rgb\""), V4);
    EXPECT_EQ(versionOf("ColorSpace \"srgb\""), V4);
    EXPECT_EQ(versionOf("Texture \"a\" \"color\" \"constant\""), V3);
    EXPECT_EQ(versionOf("LightSource \"infinite\" \"string mapname\" \"a.exr\""), V3);
    EXPECT_EQ(versionOf("LightSource \"infinite\" \"string filename\" \"a.exr\""), V4);
    EXPECT_EQ(versionOf("Identity"), V4);
}

TEST(PbrtVersion, IsSaid) {
    const Scene scene = loadV3(kTriangle);
    ASSERT_FALSE(scene.report.assumed.empty());
    EXPECT_THAT(scene.report.assumed[0], HasSubstr("pbrt-v3, as by"));
}

TEST(PbrtFile, IsToldByItsBeginning) {
    EXPECT_TRUE(looksLikePbrt("# a scene\nLookAt 0 0 1 0 0 0 0 1 0"));
    EXPECT_TRUE(looksLikePbrt("Film \"rgb\""));
    EXPECT_FALSE(looksLikePbrt("v 0 0 0"));
    EXPECT_FALSE(looksLikePbrt("<scene>"));
    EXPECT_FALSE(looksLikePbrt(""));
    const std::string text = "Film \"rgb\" WorldBegin Shape \"sphere\"";
    for (const char* name : {"named.pbrt", "unnamed"})
        EXPECT_EQ(readScene(writeFile(name, text).string()).spheres.size(), 1u) << name;
}

} // namespace
} // namespace stromboli::test

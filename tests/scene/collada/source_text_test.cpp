// Files that are no XML, are damaged, or are made to take forever: one error, in words, at once.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"
#include "tests/support/cpu_time.hpp"

namespace stromboli::test {
namespace {

using namespace std::string_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

std::string goodText() {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = meshNode();
    return document.str();
}

TEST(SourceText, WhatIsNoXmlIsNamed) {
    EXPECT_THAT(errorOf("\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s), HasSubstr("is a PNG picture"));
    EXPECT_THAT(errorOf("\xFF\xD8\xFF\xE0"), HasSubstr("is a JPEG picture"));
    EXPECT_THAT(errorOf("glTF\2\0\0\0"s), HasSubstr("is a glTF binary"));
    EXPECT_THAT(errorOf("\x1F\x8B\x08"), HasSubstr("compressed by gzip"));
    EXPECT_THAT(errorOf("Kaydara FBX Binary  \0"s), HasSubstr("is an FBX file"));
    EXPECT_THAT(errorOf("BLENDER-v280"), HasSubstr("is a Blender file"));
    EXPECT_THAT(errorOf("\x7F"
                        "ELF"),
                HasSubstr("is a program"));
    EXPECT_THAT(errorOf("solid cube\nfacet normal 0 0 1\n"),
                HasSubstr("is not XML: it begins with 'solid cube' where '<' was expected"));
    EXPECT_THAT(errorOf("v 0 0 0 and so on and so forth"), HasSubstr("'v 0 0 0 and so on an'"));
}

TEST(SourceText, BytesOfValueZeroAreFound) {
    std::string text = goodText();
    text[text.find("float_array")] = '\0';
    EXPECT_THAT(errorOf(text), MatchesRegex(".*\\.dae:4: has a byte of value 0: .*"));
}

TEST(SourceText, TheParsersErrorsAreWords) {
    for (const char* text : {"<",
                             "<a",
                             "<a ",
                             "<a b",
                             "<a b=",
                             "<a b='",
                             "<a b=''",
                             "<a>",
                             "<a>x",
                             "<a><",
                             "<a></",
                             "<a></b>",
                             "<a b='1' b='2'/>",
                             "<!--",
                             "<![CDATA[",
                             "<a><![CDATA[x</a>",
                             "<?xml",
                             "<!x",
                             "<a/><?xml?>",
                             "<a>\n<b>\n</a>",
                             "<1/>",
                             "<a 1='2'/>"})
        EXPECT_THAT(errorOf(text),
                    AllOf(HasSubstr("not well-formed XML: "), Not(HasSubstr("XML_"))))
            << text;
}

TEST(SourceText, FilesThatAreCutShortAreSaidToBe) {
    const std::string text = goodText();
    for (const char* at : {"count=", "0 0 0 1 0", "source=", "url="}) {
        const size_t end = text.find(at) + 3;
        EXPECT_THAT(errorOf(text.substr(0, end)), HasSubstr("the file is cut short")) << at;
    }
    EXPECT_THAT(errorOf("<a></b>"), Not(HasSubstr("cut short")));
}

TEST(SourceText, HalfACharacterOfUtf16) {
    EXPECT_THAT(errorOf("\xFF\xFE<\0a"s), HasSubstr("is it cut short?"));
    EXPECT_THAT(errorOf("\xFE\xFF\0<\xD8\x3C"s), HasSubstr("half a character"));
}

TEST(SourceText, Utf16IsReadAsUtf8Is) {
    const std::string text = goodText();
    std::string little = "\xFF\xFE", big = "\xFE\xFF";
    for (const char c : text)
        little += std::string{c, '\0'}, big += std::string{'\0', c};
    for (const std::string& utf16 : {little, big})
        EXPECT_EQ(loadText(utf16).positions, loadText(text).positions);
    // Errors name the same line.
    const std::string broken = "\n\n<COLLADA><scene/></COLLADA>";
    std::string wide = "\xFE\xFF";
    for (const char c : broken)
        wide += std::string{'\0', c};
    EXPECT_THAT(errorOf(wide), MatchesRegex(".*\\.dae:3: <scene>: .*"));
}

/// The parser compares each attribute with all others: half a million would take minutes.
TEST(SourceText, ManyAttributesOfOneElementAreRefusedAtOnce) {
    std::string text = "<COLLADA>\n<asset";
    for (int i = 0; i < 500000; ++i)
        text += fmt::format(" a{}=\"<>\"", i);
    const double before = test::cpuSeconds();
    EXPECT_THAT(errorOf(text + "/></COLLADA>"),
                MatchesRegex(".*\\.dae:2: <asset>: has more than 1000 attributes"));
    EXPECT_LT(test::cpuSeconds() - before, 5);
}

TEST(SourceText, ManyAttributesOfManyElementsAreNot) {
    std::string text = goodText();
    std::string libraries;
    for (int i = 0; i < 2000; ++i)
        libraries += "<library_images a=\"=\" b='x=1 y=2'/><!-- a=1 a=2 a=3 -->";
    text.insert(text.find("<library_geometries"), libraries);
    EXPECT_EQ(errorOf(text), "no error");
}

} // namespace
} // namespace stromboli::test

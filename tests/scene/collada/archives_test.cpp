// COLLADA archives (.zae).

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

#include <zip.h>

#include <random>
#include <utility>
#include <vector>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::MatchesRegex;

using Files = std::vector<std::pair<std::string, std::string>>;

class Archives : public testing::Test {
  protected:
    ~Archives() override { std::filesystem::remove(file_); }

    /// Packs names and contents.
    void pack(const Files& files) const {
        std::filesystem::remove(file_);
        zip_t* archive = zip_open(file_.c_str(), ZIP_CREATE, nullptr);
        ASSERT_NE(archive, nullptr);
        for (const auto& [name, content] : files)
            zip_file_add(archive, name.c_str(),
                         zip_source_buffer(archive, content.data(), content.size(), 0), 0);
        ASSERT_EQ(zip_close(archive), 0);
    }

    std::string bytes() const {
        std::ifstream in(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void setBytes(const std::string& bytes) const {
        std::ofstream(file_, std::ios::binary) << bytes;
    }

    Scene load(bool strict = false) const {
        SceneConventions conventions;
        conventions.strict = strict;
        return loadCollada(file_, conventions);
    }
    std::string error(bool strict = false) const {
        try {
            load(strict);
        } catch (const SceneError& e) {
            return e.what();
        }
        return "no error";
    }

    static std::string document(const std::string& nodes = meshNode()) {
        DocumentText text;
        text.libraries = triangleLibrary();
        text.nodes = nodes;
        return text.str();
    }
    static std::string manifest(const std::string& root) {
        return "<?xml version=\"1.0\"?>\r\n<dae_root>" + root + "</dae_root>";
    }

    std::filesystem::path file_ =
        std::filesystem::path(testing::TempDir()) / fmt::format("stromboli_{}.zae", getpid());
};

TEST_F(Archives, TheManifestNamesTheDocument) {
    for (const auto& [name, root] : {std::pair{"a.dae", "a.dae"},
                                     {"a.dae", "./a.dae"},
                                     {"models/the duck.dae", "\n ./models/the%20duck.dae\n"}}) {
        pack({{"0.dae", "<wrong"}, {name, document()}, {"manifest.xml", manifest(root)}});
        EXPECT_EQ(load(true).triangles.size(), 1u) << name;
    }
}

TEST_F(Archives, TheOnlyDocumentIsTakenWithoutAManifest) {
    pack({{"textures/a.png", "\x89PNG"},
          {"models/Duck.DAE", document()},
          {"__MACOSX/models/._Duck.DAE", "Mac OS X"}});
    const Scene scene = load();
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_THAT(scene.report.forgiven,
                ElementsAre(AllOf(HasSubstr("no manifest.xml"), HasSubstr("'models/Duck.DAE'"))));
    EXPECT_THAT(error(true), HasSubstr("--strict"));
}

TEST_F(Archives, WhatCannotBeToldIsAnError) {
    pack({{"a.dae", document()}, {"b.dae", document()}});
    EXPECT_THAT(error(), HasSubstr("holds 2 documents and no manifest.xml"));
    pack({{"a.png", "x"}});
    EXPECT_THAT(error(), HasSubstr("holds no COLLADA document"));
    pack({{"a.png", "x"}, {"__MACOSX/b.obj", ""}, {"a/room.obj", "v 0 0 0"}});
    EXPECT_THAT(error(), HasSubstr("but 'a/room.obj': expected the archive unpacked"));
    pack({{"a.dae", document()}, {"manifest.xml", manifest("b.dae")}});
    EXPECT_THAT(error(), HasSubstr("names 'b.dae', which it does not hold"));
    for (const char* text : {"", "<dae_root/>", "<root>a.dae</root>", "a.dae"}) {
        pack({{"a.dae", document()}, {"manifest.xml", text}});
        EXPECT_THAT(error(), HasSubstr("expected <dae_root>")) << text;
    }
    setBytes(std::string("PK\5\6", 4) + std::string(18, '\0'));
    EXPECT_THAT(error(), HasSubstr("holds no COLLADA document"));
}

TEST_F(Archives, ErrorsNameTheDocumentInTheArchive) {
    pack({{"a.dae", document("\n<node><instance_geometry url=\"#gone\"/></node>")},
          {"manifest.xml", manifest("a.dae")}});
    EXPECT_THAT(error(), MatchesRegex(".*\\.zae/a\\.dae:7: <instance_geometry>: .*"));
}

TEST_F(Archives, DamagedOnesAreErrors) {
    pack({{"a.dae", document()}});
    const std::string good = bytes();
    ASSERT_EQ(error(), "no error");
    for (const size_t length : {good.size() - 1, good.size() / 2, size_t(30), size_t(4)}) {
        setBytes(good.substr(0, length));
        EXPECT_THAT(error(), HasSubstr("the archive cannot be read")) << length;
    }
    std::string damaged = good;
    damaged[60] = char(damaged[60] ^ 0xFF); // in the packed bytes of the document
    setBytes(damaged);
    EXPECT_THAT(error(), HasSubstr("'a.dae' is damaged"));
}

/// Writes a size into the archive's directory, as those do that are made to fill memory.
std::string withStatedSize(std::string archive, uint32_t size) {
    const size_t entry = archive.find("PK\1\2");
    for (size_t i = 0; i < 4; ++i)
        archive[entry + 24 + i] = char(size >> (8 * i));
    return archive;
}

TEST_F(Archives, StatedSizesAreNotBelieved) {
    pack({{"a.dae", document()}});
    const std::string good = bytes();
    for (const uint32_t size : {1u, 100u, 0xFFFFFFF0u}) {
        setBytes(withStatedSize(good, size));
        EXPECT_THAT(error(), AllOf(HasSubstr(".zae"), HasSubstr("'a.dae'"))) << size;
    }
}

/// A scene or an error, never a crash; worth running with STROMBOLI_SANITIZE=address,undefined.
TEST_F(Archives, AnyDamagedByte) {
    pack({{"a.dae", document()}, {"manifest.xml", manifest("a.dae")}});
    const std::string good = bytes();
    std::mt19937 random(3);
    int scenes = 0, errors = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string damaged = good.substr(0, i % 4 == 0 ? random() % good.size() : good.size());
        if (!damaged.empty()) damaged[random() % damaged.size()] ^= char(1u << (random() % 8));
        setBytes(damaged);
        (error() == "no error" ? scenes : errors) += 1;
    }
    EXPECT_GT(scenes, 100);
    EXPECT_GT(errors, 100);
}

TEST_F(Archives, AManifestIsShort) {
    pack({{"manifest.xml", std::string(1 << 20, ' ')}, {"a.dae", document()}});
    EXPECT_THAT(error(), HasSubstr("'manifest.xml' has 1048576 bytes, expected at most 65536"));
}

} // namespace
} // namespace stromboli::test

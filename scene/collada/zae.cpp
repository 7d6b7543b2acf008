#include "scene/collada/zae.hpp"

#include "host/core/error.hpp"
#include "scene/build/percent_decoding.hpp"
#include "scene/build/read_file.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>
#include <zip.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

namespace stromboli::collada {
namespace {

constexpr std::string_view kManifest = "manifest.xml";
/// A manifest names one path; this is sixteen times the longest that Linux has.
constexpr uint64_t kMostOfManifest = 65536;
constexpr uint64_t kPiece = 1 << 20; // bytes that are unpacked at a time

class Archive {
  public:
    /// `bytes` must outlive the archive.
    Archive(std::string file, std::string_view bytes) : file_(std::move(file)) {
        zip_error_t error;
        zip_error_init(&error);
        zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
        if (source) zip_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
        const std::string problem = zip_ ? "" : zip_error_strerror(&error);
        zip_error_fini(&error);
        if (zip_) return;
        if (source) zip_source_free(source);
        fail("the archive cannot be read: " + problem);
    }

    /// The names of its files, in the archive's order.
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (zip_int64_t i = 0; i < zip_get_num_entries(zip_.get(), 0); ++i)
            if (const char* name = zip_get_name(zip_.get(), zip_uint64_t(i), 0))
                names.emplace_back(name);
        return names;
    }

    bool has(const std::string& name) const {
        return zip_name_locate(zip_.get(), name.c_str(), 0) >= 0;
    }

    /// Unpacks a file. The archive states its size beforehand: what is larger than that, or than
    /// `most`, is refused before it fills the memory.
    std::string unpack(const std::string& name, std::optional<uint64_t> most = std::nullopt) const {
        zip_stat_t stat;
        const bool known =
            zip_stat(zip_.get(), name.c_str(), 0, &stat) == 0 && (stat.valid & ZIP_STAT_SIZE) != 0;
        if (!known) fail(fmt::format("its '{}' states no size", name));
        if (most && stat.size > *most)
            fail(fmt::format("its '{}' has {} bytes, expected at most {}", name, stat.size, *most));
        build::requireMemory(nameOf(name), stat.size);
        const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> in(
            zip_fopen(zip_.get(), name.c_str(), 0), zip_fclose);
        if (!in)
            fail(fmt::format("its '{}' cannot be unpacked: {}", name, zip_strerror(zip_.get())));
        // In pieces, so that no more memory is taken than there turns out to be bytes.
        std::string bytes;
        zip_int64_t got = 1;
        while (got > 0 && bytes.size() < stat.size) {
            const size_t done = bytes.size();
            bytes.resize(done + size_t(std::min<uint64_t>(stat.size - done, kPiece)));
            got = zip_fread(in.get(), bytes.data() + done, bytes.size() - done);
            bytes.resize(done + size_t(std::max<zip_int64_t>(got, 0)));
        }
        char beyond = 0;
        // At the end the library compares the checksum.
        const bool whole = bytes.size() == stat.size && zip_fread(in.get(), &beyond, 1) == 0;
        if (!whole) fail(fmt::format("its '{}' is damaged", name));
        return bytes;
    }

    std::string nameOf(const std::string& name) const { return file_ + "/" + name; }
    [[noreturn]] void fail(const std::string& message) const {
        throw SceneError(file_, 0, "", message);
    }

  private:
    struct Discard {
        void operator()(zip_t* archive) const { zip_discard(archive); }
    };
    std::string file_;
    std::unique_ptr<zip_t, Discard> zip_;
};

bool endsInDae(const std::string& name) {
    constexpr std::string_view ending = ".dae";
    return name.size() > ending.size() &&
           std::equal(ending.rbegin(), ending.rend(), name.rbegin(),
                      [](char a, char b) { return a == b || (a >= 'a' && a - 'a' + 'A' == b); });
}

/// The path in `<dae_root>./a%20scene.dae</dae_root>`, as the archive writes it.
std::string rootOfManifest(const Archive& archive) {
    const std::string text = archive.unpack(std::string(kManifest), kMostOfManifest);
    tinyxml2::XMLDocument xml;
    const bool parsed = xml.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS;
    const tinyxml2::XMLElement* root = parsed ? xml.RootElement() : nullptr;
    const bool named = root && std::string_view(root->Name()) == "dae_root" && root->GetText();
    if (!named)
        archive.fail(
            "its manifest.xml does not name a document: expected <dae_root>PATH</dae_root>");
    std::string path = build::percentDecoded(root->GetText());
    const char* spaces = " \t\r\n";
    path.erase(0, std::min(path.find_first_not_of(spaces), path.size()));
    path.erase(path.find_last_not_of(spaces) + 1);
    while (path.starts_with("./"))
        path.erase(0, 2);
    if (!archive.has(path))
        archive.fail(fmt::format("its manifest.xml names '{}', which it does not hold", path));
    return path;
}

/// Models are handed on as archives of all kinds.
[[noreturn]] void failWithoutDocument(const Archive& archive) {
    const std::vector<std::string> names = archive.names();
    const auto isScene = [](const std::string& name) {
        const std::filesystem::path path(name);
        constexpr std::string_view endings[] = {".glb", ".gltf", ".obj", ".fbx", ".pbrt",
                                                ".xml", ".ply",  ".stl", ".3ds"};
        return !name.starts_with("__MACOSX/") &&
               std::ranges::find(endings, path.extension().string()) != std::end(endings);
    };
    const auto scene = std::ranges::find_if(names, isScene);
    if (scene == names.end()) archive.fail("the archive holds no COLLADA document (.dae)");
    archive.fail(fmt::format("the archive holds no COLLADA document (.dae), but '{}': expected the "
                             "archive unpacked, and that file in it",
                             scene->substr(0, 200)));
}

std::string onlyDocument(const Archive& archive, const std::string& file, build::Report& report) {
    std::vector<std::string> documents = archive.names();
    // macOS packs a companion of a few bytes for each file, of the same ending, in a folder of its
    // own.
    std::erase_if(documents, [](const std::string& name) {
        return !endsInDae(name) || name.starts_with("__MACOSX/");
    });
    if (documents.empty()) failWithoutDocument(archive);
    if (documents.size() > 1)
        archive.fail(fmt::format("the archive holds {} documents and no manifest.xml that says "
                                 "which is meant",
                                 documents.size()));
    report.forgive({file, 0, ""}, "the archive has no manifest.xml",
                   fmt::format("its only document, '{}', is read", documents.front()));
    return documents.front();
}

} // namespace

bool isArchive(std::string_view bytes) {
    return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06"); // with files; empty
}

PackedDocument readZae(const std::string& file, std::string_view bytes, build::Report& report) {
    const Archive archive(file, bytes);
    const std::string name = archive.has(std::string(kManifest))
                                 ? rootOfManifest(archive)
                                 : onlyDocument(archive, file, report);
    return {archive.nameOf(name), name, archive.unpack(name)};
}

std::optional<std::string> readFromArchive(const std::string& file, std::string_view bytes,
                                           const std::string& path) {
    const Archive archive(file, bytes);
    if (!archive.has(path)) return std::nullopt;
    return archive.unpack(path);
}

} // namespace stromboli::collada

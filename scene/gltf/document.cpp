#include "scene/gltf/document.hpp"

#include "host/core/error.hpp"
#include "scene/build/file_store.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/unicode.hpp"
#include "scene/gltf/extensions.hpp"
#include "scene/gltf/lenient_json.hpp"
#include "scene/gltf/meshopt.hpp"
#include "scene/gltf/uri.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace stromboli::gltf {
namespace {

/// Levels of brackets within each other: files of this format have about ten, without `extras`.
constexpr int kDeepest = 256;

Json readJson(const std::string& file, const std::string& text, FileParts& parts) {
    std::string problem;
    try {
        return parseJson(text, kDeepest);
    } catch (const JsonError& error) {
        problem = error.what();
    }
    try {
        Json json = parseJson(correctedJson(text), kDeepest);
        parts.oddities.push_back({problem, "comments and commas in front of brackets are skipped, "
                                           "numbers that are none count as absent"});
        return json;
    } catch (const JsonError&) {
        throw SceneError(file, 0, "", fmt::format("is no glTF: {}", problem));
    }
}

std::shared_ptr<FileParts> readParts(const std::string& file) {
    auto parts = std::make_shared<FileParts>();
    parts->bytes = build::readFile(file);
    parts->container = openContainer(file, parts->bytes);
    std::string json(parts->container.json);
    if (build::utf16Beginning(json))
        if (std::optional<std::string> text = build::textInUtf8(json)) {
            json = *std::move(text);
            parts->oddities.push_back({"is in UTF-16", "it is read as if it were in UTF-8"});
        }
    if (std::string characters = build::utf8WithLatin1(json); characters != json) {
        json = std::move(characters);
        parts->oddities.push_back(
            {"has bytes that are no UTF-8", "they are read as characters of Latin-1"});
    }
    parts->json = std::make_shared<const Json>(readJson(file, json, *parts));
    return parts;
}

} // namespace

Document::Document(const std::filesystem::path& file, build::Report& report, build::FileStore* kept)
    : report_(&report), path_(file), file_(file.string()) {
    const auto read = [&] { return readParts(file_); };
    parts_ = kept ? kept->parts<FileParts>(file_, read) : read();
    for (const auto& [problem, reading] : parts_->oddities)
        report.forgive({file_, 0, ""}, problem, reading);
    if (!parts_->container.problem.empty())
        report.forgive({file_, 0, ""}, parts_->container.problem, "all of its chunks are there");
    root_ = std::make_unique<Element>(file_, "", *parts_->json, &report);
    requireVersion(report);
    checkExtensions(report);
}

void Document::requireVersion(build::Report& report) const {
    const std::optional<Element> asset = root_->child("asset");
    // Lists of accessors are arrays since version 2.
    const auto accessors = parts_->json->find("accessors");
    const bool isLikeVersion2 = accessors != parts_->json->end() && accessors->is_array();
    const char* const reading = "the file is read as glTF 2.0";
    if (!asset && !isLikeVersion2) root_->fail("is no glTF 2.0: it has no 'asset'");
    if (!asset) return report.forgive(root_->place(), "has no 'asset'", reading);
    if (!asset->has("version") && !isLikeVersion2) asset->fail("has no 'version'");
    if (!asset->has("version")) report.forgive(asset->place(), "has no 'version'", reading);
    const std::string version = asset->text("version", "2.0");
    if (!version.starts_with("2."))
        asset->fail("version", fmt::format("is '{}', expected 2.0", version));
    const std::string least = asset->text("minVersion", "2.0");
    if (least != "2.0")
        report.forgive({file_, 0, "asset.minVersion"}, fmt::format("is '{}'", least), reading);
}

void Document::checkExtensions(build::Report& report) const {
    for (const std::string& name : root_->texts("extensionsRequired"))
        if (!isReadExtension(name))
            report.replace({file_, 0, "extensionsRequired"}, build::Shortfall::Extension,
                           fmt::format("the file requires '{}', which is not read", name));
}

Element Document::at(std::string_view array, size_t index) const {
    const bool isAboutBytes =
        array == "accessors" || array == "bufferViews" || array == "buffers" || array == "skins";
    return (isAboutBytes ? root_->strictly() : *root_).item(array, index);
}

std::optional<Element> Document::follow(const Element& from, std::string_view member,
                                        std::string_view array) const {
    const std::optional<size_t> index = from.index(member, size(array));
    if (!index) return std::nullopt;
    return at(array, *index);
}

std::string Document::bytesOfUri(const std::string& uri, const Element& element) const {
    return readUri(path_.parent_path(), uri, element.place(), *report_);
}

std::string_view Document::bytesOfBuffer(size_t index) const {
    const Element buffer = at("buffers", index);
    std::string_view bytes;
    if (!buffer.has("uri")) {
        if (index != 0 || !parts_->container.binary)
            buffer.fail("has no 'uri', and no part of the file holds its bytes");
        bytes = *parts_->container.binary;
    } else {
        const auto found = parts_->buffers.find(index);
        bytes = found != parts_->buffers.end()
                    ? found->second
                    : parts_->buffers.emplace(index, bytesOfUri(buffer.text("uri"), buffer))
                          .first->second;
    }
    const uint64_t length = buffer.count("byteLength");
    if (length > bytes.size())
        buffer.fail("byteLength",
                    fmt::format("is {}, but there are {} bytes", length, bytes.size()));
    return bytes.substr(0, length);
}

/// `buffer`, `byteOffset` and `byteLength` of a view, or of what a view is unpacked from.
std::string_view Document::part(const Element& view) const {
    const std::optional<size_t> buffer = view.index("buffer", size("buffers"));
    if (!buffer) view.fail("has no 'buffer'");
    const uint64_t offset = view.count("byteOffset", 0), length = view.count("byteLength");
    const std::string_view bytes = bytesOfBuffer(*buffer);
    if (offset > bytes.size() || length > bytes.size() - offset)
        view.fail(fmt::format("{} bytes from {} on are beyond the {} bytes of buffers[{}]", length,
                              offset, bytes.size(), *buffer));
    return bytes.substr(offset, length);
}

std::string_view Document::bytesOfView(size_t index) const {
    const Element view = at("bufferViews", index);
    const std::optional<Element> packed = view.extension("EXT_meshopt_compression");
    if (!packed) return part(view);
    const auto found = parts_->unpackedViews.find(index);
    if (found != parts_->unpackedViews.end()) return found->second;
    return parts_->unpackedViews.emplace(index, unpackMeshopt(*packed, part(*packed)))
        .first->second;
}

void reportExtensions(const Document& document, build::Report& report) {
    for (const std::string& name : document.root().texts("extensionsUsed"))
        if (!isReadExtension(name))
            report.ignore(fmt::format("extension '{}'", name), "it is not read");
}

} // namespace stromboli::gltf

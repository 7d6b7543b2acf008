#pragma once

#include "host/core/json.hpp"
#include "scene/build/scene_builder.hpp"
#include "scene/gltf/container.hpp"
#include "scene/gltf/element.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace stromboli::gltf {

/// What is read of a file, whatever is made of it.
struct FileParts {
    std::string bytes;
    Container container; ///< views of the bytes
    std::shared_ptr<const Json> json;
    /// What is wrong with the text, and how it is read.
    std::vector<std::pair<std::string, std::string>> oddities;
    std::map<size_t, std::string> buffers, unpackedViews; ///< those that were asked for
};

/// A glTF 2.0 file: its JSON, and the bytes that it names, which are read when they are asked for
/// and kept.
class Document {
  public:
    /// Throws SceneError if it is no glTF 2. What is missing of it is said in the report, which
    /// must outlive the document. kept: where its parts are from, and are left for the next
    /// document of this file; may be null.
    Document(const std::filesystem::path& file, build::Report& report,
             build::FileStore* kept = nullptr);

    const std::string& file() const { return file_; }
    const Element& root() const { return *root_; }
    /// Element `index` of one of the file's arrays, such as "meshes". What is wrong in one of those
    /// that say where bytes lie is an error: guesses would show something else.
    Element at(std::string_view array, size_t index) const;
    size_t size(std::string_view array) const { return root_->size(array); }
    /// The element of `array` that a member names by its number; nothing if it is not there.
    std::optional<Element> follow(const Element& from, std::string_view member,
                                  std::string_view array) const;

    /// The bytes of a bufferView, decompressed if need be; throws SceneError unless the buffer has
    /// all of them.
    std::string_view bytesOfView(size_t view) const;
    /// The bytes of a URI of the file.
    std::string bytesOfUri(const std::string& uri, const Element& at) const;

  private:
    std::string_view bytesOfBuffer(size_t buffer) const;
    std::string_view part(const Element& view) const;
    void requireVersion(build::Report& report) const;
    void checkExtensions(build::Report& report) const;

    build::Report* report_;
    std::filesystem::path path_;
    std::string file_; ///< path_, for messages
    std::shared_ptr<FileParts> parts_;
    std::unique_ptr<Element> root_;
};

/// Says which of the extensions that the file uses have no effect.
void reportExtensions(const Document& document, build::Report& report);

} // namespace stromboli::gltf

#include "scene/obj/pictures.hpp"

#include "host/core/error.hpp"
#include "host/core/memory.hpp"
#include "scene/build/folder.hpp"
#include "scene/build/read_file.hpp"
#include "scene/images/texture_image.hpp"
#include "scene/obj/texel_mix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace stromboli::obj {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReading = "there is no picture on the surface";

bool isThere(const fs::path& folder, const fs::path& relative) {
    if (relative.empty() || relative.is_absolute()) return false;
    std::error_code error;
    const fs::path path = folder / relative;
    return fs::is_regular_file(path, error) && build::liesBelow(folder, path);
}

bool hasDrive(std::string_view path) {
    return path.size() >= 2 && path[1] == ':' && std::isalpha(static_cast<unsigned char>(path[0]));
}

bool leadsOut(const fs::path& normal) {
    return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

/// What makes two uses of a picture differ in the texture that is made for them.
std::string keyOf(const Map& map) {
    return fmt::format("{}\n{}\n{}\n", map.name, int(map.channel), map.clamp);
}

std::string keyOf(const std::optional<Map>& map) {
    return map ? keyOf(*map) : "";
}

} // namespace

Companion companion(const fs::path& folder, std::string_view written) {
    // A zero byte would end the name for the system and not for the checks.
    if (written.empty() || written.find('\0') != std::string_view::npos) return {};
    std::string text(written);
    const bool hasBackslashes = text.find('\\') != std::string::npos;
    std::replace(text.begin(), text.end(), '\\', '/');
    const fs::path path = fs::path(text).lexically_normal();
    if (!hasDrive(text) && !leadsOut(path) && isThere(folder, path)) {
        if (!hasBackslashes) return {folder / path, "", ""};
        return {folder / path, fmt::format("'{}' has backslashes", shortened(written)),
                "they are read as slashes"};
    }
    const fs::path name = path.filename();
    if (name == "." || name == ".." || !isThere(folder, name)) return {};
    return {folder / name,
            fmt::format("'{}' leads to no file in the file's folder", shortened(written)),
            "the file of the same name beside it is taken"};
}

std::optional<TextureImage> Pictures::read(const Map& map, bool srgb) {
    build::Report& report = builder_.report();
    const bool isFile = map.content.empty();
    const Companion file = isFile ? companion(folder_, map.name) : Companion{};
    if (isFile && !file.path) {
        report.forgive(map.place,
                       fmt::format("'{}' is not in the file's folder", shortened(map.name)),
                       kReading);
        return std::nullopt;
    }
    std::optional<TextureImage> image;
    std::string problem;
    try {
        const std::string name = map.place.describe(shortened(map.name));
        const std::string read = isFile ? build::readFile(*file.path) : "";
        const std::string_view content = isFile ? std::string_view(read) : map.content;
        image = images::textureImage(
            images::decodePicture(content, isFile ? file.path->string() : name), name, srgb);
    } catch (const SceneError& error) {
        problem = error.what();
    }
    if (!image) {
        report.forgive(map.place, problem, kReading);
        return std::nullopt;
    }
    if (!file.problem.empty()) report.forgive(map.place, file.problem, file.reading);
    return image;
}

std::optional<TextureImage> Pictures::read(const std::optional<Map>& map, bool srgb) {
    return map ? read(*map, srgb) : std::nullopt;
}

/// A picture of one colour takes a few bytes in a file, and a file names any number of them.
uint32_t Pictures::keep(TextureImage image, const Map& map, bool srgb) {
    const uint32_t largest = builder_.conventions().selection.largestTexture;
    if (largest > 0) images::shrinkToFit(image, largest, srgb);
    bytes_ += image.words.size() * sizeof(uint32_t);
    if (bytes_ > physicalMemory() / 2)
        map.place.fail(
            fmt::format("brings the pictures to {} MiB, more than half of this machine's "
                        "memory; --max-texture N shrinks them",
                        bytes_ >> 20));
    Texture texture;
    texture.image = builder_.addImage(std::move(image));
    texture.srgb = srgb;
    if (map.clamp) texture.wrapU = texture.wrapV = Wrap::Clamp;
    return builder_.addTexture(texture);
}

template <typename Make>
std::optional<uint32_t> Pictures::once(const std::string& key, Make make) {
    const auto found = made_.find(key);
    if (found != made_.end()) return found->second;
    const std::optional<uint32_t> number = make();
    made_.emplace(key, number);
    return number;
}

std::optional<uint32_t> Pictures::colors(const Map& map) {
    return once("colours\n" + keyOf(map), [&]() -> std::optional<uint32_t> {
        std::optional<TextureImage> image = read(map, true);
        if (!image) return std::nullopt;
        return keep(std::move(*image), map, true);
    });
}

std::optional<uint32_t> Pictures::normals(const Map& map) {
    return once("normals\n" + keyOf(map), [&]() -> std::optional<uint32_t> {
        std::optional<TextureImage> image = read(map, false);
        if (!image) return std::nullopt;
        return keep(std::move(*image), map, false);
    });
}

std::optional<uint32_t> Pictures::colorsWithOpacity(const std::optional<Map>& color,
                                                    const std::optional<Map>& opacity) {
    const std::string key = "opacity\n" + keyOf(color) + "\n" + keyOf(opacity);
    return once(key, [&]() -> std::optional<uint32_t> {
        const std::optional<TextureImage> colors = read(color, true), mask = read(opacity, false);
        if (!colors && !mask) return std::nullopt;
        ChannelSource alpha;
        if (mask) alpha = {&*mask, resolvedChannel(*mask, opacity->channel, true)};
        return keep(withAlpha(colors ? &*colors : nullptr, alpha), color ? *color : *opacity, true);
    });
}

std::optional<uint32_t> Pictures::roughnessMetallic(const std::optional<Map>& roughness,
                                                    const std::optional<Map>& metallic) {
    const std::string key = "roughness\n" + keyOf(roughness) + "\n" + keyOf(metallic);
    return once(key, [&]() -> std::optional<uint32_t> {
        const std::optional<TextureImage> rough = read(roughness, false);
        const std::optional<TextureImage> metal = read(metallic, false);
        if (!rough && !metal) return std::nullopt;
        const auto source = [](const std::optional<TextureImage>& image,
                               const std::optional<Map>& map) -> ChannelSource {
            if (!image) return {};
            return {&*image, resolvedChannel(*image, map->channel, false)};
        };
        return keep(obj::roughnessMetallic(source(rough, roughness), source(metal, metallic)),
                    roughness ? *roughness : *metallic, false);
    });
}

} // namespace stromboli::obj

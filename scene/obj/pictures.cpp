#include "scene/obj/pictures.hpp"

#include "host/core/system.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/texels.hpp"
#include "scene/images/load_texture.hpp"
#include "scene/images/texture_image.hpp"
#include "scene/obj/texel_mix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace stromboli::obj {
namespace {

namespace fs = std::filesystem;

/// What makes two uses of a picture differ in the texture that is made for them.
std::string keyOf(const Map& map) {
    return fmt::format("{}\n{}\n{}\n", map.name, int(map.channel), map.clamp);
}

std::string keyOf(const std::optional<Map>& map) {
    return map ? keyOf(*map) : "";
}

/// Directions are as blue as the z axis in the mean, and greys of heights are not.
bool lookLikeNormals(const TextureImage& image) {
    const size_t count = size_t(image.width) * image.height;
    constexpr size_t kMostTexels = 4096;
    const size_t step = std::max<size_t>(count / kMostTexels, 1);
    glm::dvec3 sum(0.0);
    double looked = 0;
    for (size_t i = 0; i < count; i += step, ++looked)
        sum += build::colorAt(image, i, false);
    const glm::dvec3 away = glm::abs(sum / looked - glm::dvec3(0.5, 0.5, 0.9));
    return away.x < 0.15 && away.y < 0.15 && away.z < 0.2;
}

} // namespace

/// Names count from the file that states the material, or else from the scene's.
build::Companion Pictures::fileOf(const Map& map) const {
    const fs::path own = fs::path(map.place.file).parent_path().lexically_relative(folder_);
    build::Companion beside;
    if (!own.empty() && own != ".") {
        std::string name = map.name;
        std::replace(name.begin(), name.end(), '\\', '/');
        beside = build::pictureCompanion(folder_, (own / name).generic_string());
        if (beside.path && beside.problem.empty()) return beside;
    }
    build::Companion file = build::pictureCompanion(folder_, map.name);
    const bool isBetter = file.path && (file.problem.empty() || !beside.path);
    return isBetter ? file : beside;
}

std::optional<TextureImage> Pictures::read(const Map& map, bool srgb) {
    build::Report& report = builder_.report();
    const bool isFile = map.content.empty();
    const build::Companion file = isFile ? fileOf(map) : build::Companion{};
    if (isFile && !file.path) {
        report.replace(map.place, build::Shortfall::Picture,
                       fmt::format("'{}' is not in the file's folder", shortened(map.name)));
        return std::nullopt;
    }
    std::string bytes;
    const auto bytesOf = [&]() -> std::string_view {
        if (!isFile) return map.content;
        bytes = build::readFile(*file.path);
        return bytes;
    };
    const std::string name = isFile ? file.path->string() : map.place.describe(shortened(map.name));
    std::optional<TextureImage> image = images::loadTexture(bytesOf, name, srgb, map.place, report);
    if (image && !file.problem.empty()) report.forgive(map.place, file.problem, file.reading);
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

std::optional<uint32_t> Pictures::normalsOfBump(const Map& map) {
    return once("bumps\n" + keyOf(map), [&]() -> std::optional<uint32_t> {
        std::optional<TextureImage> image = read(map, false);
        if (!image || !lookLikeNormals(*image)) return std::nullopt;
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

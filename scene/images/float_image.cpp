#include "scene/images/float_image.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"
#include "scene/images/picture.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace stromboli::images {
namespace {

/// Linear light of every value that an integer channel can have.
template <class Value>
std::vector<float> decodingTable() {
    constexpr size_t most = std::numeric_limits<Value>::max();
    std::vector<float> table(most + 1);
    for (size_t i = 0; i <= most; ++i)
        table[i] = float(srgbToLinear(double(i) / double(most)));
    return table;
}

template <class Value>
void toLinear(const std::vector<Value>& values, std::vector<glm::vec3>& texels) {
    const std::vector<float> table = decodingTable<Value>();
    for (size_t i = 0; i < texels.size(); ++i)
        texels[i] = {table[values[4 * i]], table[values[4 * i + 1]], table[values[4 * i + 2]]};
}

void toLinear(const std::vector<float>& values, std::vector<glm::vec3>& texels) {
    for (size_t i = 0; i < texels.size(); ++i)
        texels[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2]};
}

template <class Value>
void toRadiance(const std::vector<Value>& values, std::vector<glm::vec4>& texels) {
    const std::vector<float> table = decodingTable<Value>();
    constexpr float most = std::numeric_limits<Value>::max();
    for (size_t i = 0; i < texels.size(); ++i) {
        const float alpha = float(values[4 * i + 3]) / most; // by which files do not multiply
        texels[i] = {alpha * table[values[4 * i]], alpha * table[values[4 * i + 1]],
                     alpha * table[values[4 * i + 2]], alpha};
    }
}

void toRadiance(const std::vector<float>& values, std::vector<glm::vec4>& texels) {
    for (size_t i = 0; i < texels.size(); ++i)
        texels[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
}

/// Texels with a number that is no light get 0 in its place.
void clearWhatIsNoLight(FloatImage& image) {
    constexpr float most = std::numeric_limits<float>::max();
    size_t count = 0, first = 0;
    for (size_t i = 0; i < image.texels.size(); ++i) {
        glm::vec3& texel = image.texels[i];
        const glm::vec3 before = texel;
        bool isLight = true;
        for (int channel = 0; channel < 3; ++channel)
            if (!(texel[channel] >= 0 && texel[channel] <= most)) { // NaN compares false
                texel[channel] = 0;
                isLight = false;
            }
        if (!isLight && count++ == 0) {
            first = i;
            image.faults.push_back({build::Shortfall::EnvironmentTexel,
                                    fmt::format("({}, {}, {})", before.x, before.y, before.z)});
        }
    }
    if (count > 0)
        image.faults.back().problem =
            fmt::format("{} texels are no light, the first at ({}, {}), {}", count,
                        first % image.width, first / image.width, image.faults.back().problem);
}

/// Means of blocks of a power of two texels a side.
void shrink(FloatImage& image, uint32_t largestSide) {
    uint32_t size = 1;
    while ((std::max(image.width, image.height) - 1) / size >= largestSide)
        size *= 2;
    if (size == 1) return;
    FloatImage small{(image.width - 1) / size + 1, (image.height - 1) / size + 1, {}};
    small.texels.resize(size_t(small.width) * small.height);
    for (uint32_t y = 0; y < small.height; ++y)
        for (uint32_t x = 0; x < small.width; ++x) {
            const uint32_t right = std::min((x + 1) * size, image.width);
            const uint32_t lower = std::min((y + 1) * size, image.height);
            glm::dvec3 sum(0);
            for (uint32_t v = y * size; v < lower; ++v)
                for (uint32_t u = x * size; u < right; ++u)
                    sum += glm::dvec3(image.texels[size_t(v) * image.width + u]);
            small.texels[size_t(y) * small.width + x] =
                sum / (double(right - x * size) * double(lower - y * size));
        }
    image.faults.push_back(
        {build::Shortfall::EnvironmentSize, fmt::format("has {} x {} texels, more than {} a side",
                                                        image.width, image.height, largestSide)});
    image.width = small.width;
    image.height = small.height;
    image.texels = std::move(small.texels);
}

} // namespace

FloatImage readFloatImage(const std::filesystem::path& file, uint32_t largestSide) {
    const std::string name = file.string();
    Picture picture = decodePicture(build::readFile(file), name, largestSide);
    FloatImage image{picture.width, picture.height, {}, std::move(picture.faults)};
    image.isEightBit = std::holds_alternative<std::vector<uint8_t>>(picture.values);
    image.texels.resize(picture.texelCount());
    std::visit([&](const auto& values) { toLinear(values, image.texels); }, picture.values);
    clearWhatIsNoLight(image);
    shrink(image, largestSide);
    return image;
}

bool RadiancePicture::isTransparent() const {
    return std::ranges::any_of(texels, [](const glm::vec4& texel) { return texel.a != 1; });
}

RadiancePicture readRadiance(const std::filesystem::path& file, const std::string& layer) {
    const std::string name = file.string();
    const std::string bytes = build::readFile(file);
    PicturePart part;
    if (isExr(bytes)) {
        part = decodeExrLayer(bytes, name, layer);
    } else if (layer.empty()) {
        part.picture = decodePicture(bytes, name);
        part.width = part.picture.width, part.height = part.picture.height;
    } else {
        throw SceneError(name, 0, "", "has no layers: only OpenEXR files have them");
    }
    RadiancePicture radiance{part.picture.width, part.picture.height, part.left, part.top,
                             part.width,         part.height,         {},        {}};
    radiance.texels.resize(part.picture.texelCount());
    std::visit([&](const auto& values) { toRadiance(values, radiance.texels); },
               part.picture.values);
    radiance.faults = std::move(part.picture.faults);
    return radiance;
}

} // namespace stromboli::images

#include "scene/images/float_image.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"
#include "scene/images/picture.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

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

bool isLight(const glm::vec3& color) {
    constexpr float most = std::numeric_limits<float>::max();
    for (int channel = 0; channel < 3; ++channel)
        if (!(color[channel] >= 0 && color[channel] <= most)) return false; // NaN compares false
    return true;
}

} // namespace

FloatImage readFloatImage(const std::filesystem::path& file) {
    const std::string name = file.string();
    const Picture picture = decodePicture(build::readFile(file), name);
    FloatImage image{picture.width, picture.height, {}};
    image.texels.resize(picture.texelCount());
    std::visit([&](const auto& values) { toLinear(values, image.texels); }, picture.values);
    for (size_t i = 0; i < image.texels.size(); ++i)
        if (!isLight(image.texels[i]))
            throw SceneError(name, 0, "",
                             fmt::format("pixel ({}, {}) is ({}, {}, {}), expected finite values "
                                         "that are not negative",
                                         i % image.width, i / image.width, image.texels[i].x,
                                         image.texels[i].y, image.texels[i].z));
    return image;
}

} // namespace stromboli::images

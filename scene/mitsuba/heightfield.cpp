#include "scene/mitsuba/heightfield.hpp"

#include "scene/build/read_file.hpp"
#include "scene/build/vectors.hpp"
#include "scene/images/picture.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

/// The picture itself, or that inside of textures that scale it.
const Plugin& pictureOf(const Plugin& plugin, double& scale, int depth = 0) {
    if (plugin.tag == "shape" ? plugin.has("filename") : plugin.type == "bitmap") return plugin;
    if (plugin.type == "scale") scale *= plugin.number("scale").value_or(1);
    const std::vector<const Plugin*> inside = plugin.childrenOf("texture");
    constexpr int kMostLevels = 100;
    if (inside.empty() || depth > kMostLevels)
        plugin.fail("has no picture of heights: a filename, or a texture of the type bitmap");
    return pictureOf(*inside.front(), scale, depth + 1);
}

/// The luminance, of linear light where the picture has colours of 8 or 16 bits and is not raw.
std::vector<double> heightsOf(const images::Picture& picture, bool isRaw) {
    std::vector<double> heights;
    heights.reserve(picture.texelCount());
    std::visit(
        [&](const auto& values) {
            using T = typename std::decay_t<decltype(values)>::value_type;
            constexpr bool isFloat = std::is_same_v<T, float>;
            for (size_t i = 0; i < picture.texelCount(); ++i) {
                double height = 0;
                constexpr double kWeights[3] = {0.212671, 0.715160, 0.072169}; // Rec. 709
                for (size_t channel = 0; channel < 3; ++channel) {
                    double value = double(values[4 * i + channel]);
                    if constexpr (!isFloat) {
                        value /= double(std::numeric_limits<T>::max());
                        if (!isRaw) value = srgbToLinear(value);
                    }
                    height += kWeights[channel] * value;
                }
                heights.push_back(std::isfinite(height) ? height : 0);
            }
        },
        picture.values);
    return heights;
}

} // namespace

build::Mesh heightfieldMesh(const Context& context, const Plugin& shape) {
    double scale = shape.number("scale").value_or(1);
    const Plugin& plugin = pictureOf(shape, scale);
    const std::filesystem::path file = context.document.file(plugin, "filename");
    const images::Picture picture = images::decodePicture(build::readFile(file), file.string());
    for (const images::PictureFault& fault : picture.faults)
        plugin.replace(fault.kind, fmt::format("{}: {}", file.string(), fault.problem));
    if (picture.width < 2 || picture.height < 2)
        plugin.fail("is one texel wide or high, expected two or more");
    const bool isRaw =
        plugin.flag("raw").value_or(false) || plugin.number("gamma").value_or(0) == 1;
    const std::vector<double> heights = heightsOf(picture, isRaw);
    for (const char* unused : {"width", "height"})
        shape.skip(unused);
    build::Mesh mesh;
    const uint32_t columns = picture.width, rows = picture.height;
    build::requireMemory(file.string(), uint64_t(columns) * rows * 240);
    const auto height = [&](int64_t column, int64_t row) {
        column = std::clamp<int64_t>(column, 0, columns - 1);
        row = std::clamp<int64_t>(row, 0, rows - 1);
        return scale * heights[size_t(row) * columns + size_t(column)];
    };
    const double dx = 2.0 / (columns - 1), dy = 2.0 / (rows - 1);
    for (int64_t row = 0; row < rows; ++row)
        for (int64_t column = 0; column < columns; ++column) {
            mesh.positions.emplace_back(-1 + dx * double(column), -1 + dy * double(row),
                                        height(column, row));
            const double acrossX = dx * double(std::min<int64_t>(column + 1, columns - 1) -
                                               std::max<int64_t>(column - 1, 0));
            const double acrossY =
                dy * double(std::min<int64_t>(row + 1, rows - 1) - std::max<int64_t>(row - 1, 0));
            mesh.normals.push_back(glm::normalize(
                glm::dvec3((height(column - 1, row) - height(column + 1, row)) / acrossX,
                           (height(column, row - 1) - height(column, row + 1)) / acrossY, 1)));
            mesh.attributes.emplace_back().uv[0] = {float(column) / float(columns - 1),
                                                    float(row) / float(rows - 1)};
        }
    const bool isSmooth = shape.flag("shading_normals").value_or(true);
    if (!isSmooth) mesh.normals.clear();
    mesh.isFlat = !isSmooth;
    build::MeshPart& part = mesh.parts.emplace_back();
    for (uint32_t row = 0; row + 1 < rows; ++row)
        for (uint32_t column = 0; column + 1 < columns; ++column) {
            const auto corner = [&](uint32_t right, uint32_t up) {
                const uint32_t n = (row + up) * columns + column + right;
                return build::Corner{n, isSmooth ? n : kNoNormals, n};
            };
            part.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
            part.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
        }
    return mesh;
}

} // namespace stromboli::mitsuba

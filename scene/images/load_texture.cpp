#include "scene/images/load_texture.hpp"

#include "host/core/error.hpp"
#include "scene/images/texture_image.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::images {
namespace {

/// A texel that is no number would make a pixel that is none. Returns how many there were.
size_t clearNaNs(Picture& picture) {
    auto* values = std::get_if<std::vector<float>>(&picture.values);
    size_t count = 0;
    if (values)
        for (float& value : *values)
            if (std::isnan(value)) {
                value = 0;
                ++count;
            }
    return count;
}

} // namespace

void reportFaults(const Picture& picture, const build::FilePlace& where, const std::string& name,
                  build::Report& report) {
    for (const PictureFault& fault : picture.faults)
        report.replace(where, fault.kind, fmt::format("{}: {}", name, fault.problem));
}

std::optional<TextureImage> loadTexture(const std::function<std::string_view()>& bytesOf,
                                        const std::string& name, bool srgb,
                                        const build::FilePlace& where, build::Report& report) {
    std::optional<Picture> picture;
    std::string problem;
    try {
        picture = decodePicture(bytesOf(), name);
    } catch (const SceneError& error) {
        problem = error.what();
    }
    if (!picture) {
        report.replace(where, build::Shortfall::Picture, problem);
        return std::nullopt;
    }
    if (const size_t count = clearNaNs(*picture))
        picture->faults.push_back(
            {build::Shortfall::Texel, fmt::format("{} of its numbers are NaN", count)});
    reportFaults(*picture, where, name, report);
    return textureImage(*picture, name, srgb);
}

} // namespace stromboli::images

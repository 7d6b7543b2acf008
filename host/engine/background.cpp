#include "host/engine/background.hpp"

#include "scene/find_scene.hpp"
#include "scene/images/float_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli {

Background backgroundFrom(const std::string& file) {
    images::FloatImage image = images::readFloatImage(environmentFile(file));
    Background background{image.width, image.height, std::move(image.texels)};
    for (const images::PictureFault& fault : image.faults)
        background.faults.push_back(fmt::format("the background {}: {}: {}", file, fault.problem,
                                                build::insteadOf(fault.kind)));
    return background;
}

namespace {

/// Between the middles of texels linearly; beyond the outermost ones they go on.
glm::dvec3 texelAt(const Background& background, double x, double y) {
    const auto at = [&](double column, double row) {
        const auto c = size_t(std::clamp(column, 0.0, background.width - 1.0)),
                   r = size_t(std::clamp(row, 0.0, background.height - 1.0));
        return glm::dvec3(background.radiance[r * background.width + c]);
    };
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double u = x - 0.5 - left, v = y - 0.5 - top;
    return glm::mix(glm::mix(at(left, top), at(left + 1, top), u),
                    glm::mix(at(left, top + 1), at(left + 1, top + 1), u), v);
}

} // namespace

void putBehind(Film& film, std::span<const float> alpha, const Background& background) {
    const Crop part = film.area.rendered();
    const double scale = std::min(double(background.width) / film.area.width,
                                  double(background.height) / film.area.height);
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const double clear = 1 - double(alpha[i]);
        if (clear <= 0) continue;
        const double x = part.x + double(i % part.width) + 0.5 - film.area.width / 2.0,
                     y = part.y + double(i / part.width) + 0.5 - film.area.height / 2.0;
        film.pixels[i].mean += clear * texelAt(background, background.width / 2.0 + scale * x,
                                               background.height / 2.0 + scale * y);
    }
}

} // namespace stromboli

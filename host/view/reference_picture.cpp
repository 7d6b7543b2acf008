#include "host/view/reference_picture.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace stromboli::view {
namespace {

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

std::shared_ptr<const ReferencePicture> readReference(const std::filesystem::path& file) {
    auto reference = std::make_shared<ReferencePicture>();
    compare::Picture& picture = reference->picture;
    picture = compare::readPicture(file);
    Raster raster{picture.width, picture.height, 3, {}};
    for (glm::dvec3& pixel : picture.rgb) {
        if (!isFinite(pixel)) pixel = glm::dvec3(0);
        for (int c = 0; c < 3; ++c)
            raster.values.push_back(float(pixel[c]));
    }
    const int exponent = exponentFor(raster.values);
    const Json text = {{"width", raster.width},
                       {"height", raster.height},
                       {"channels", raster.channels},
                       {"exponent", exponent}};
    reference->frame =
        std::make_shared<const std::string>(encodeFrame(text.dump(), raster, exponent));
    return reference;
}

Json differenceJson(const ReferencePicture& reference, const Raster& radiance) {
    const compare::Picture& expected = reference.picture;
    if (expected.width != radiance.width || expected.height != radiance.height) return nullptr;
    compare::Picture picture(radiance.width, radiance.height);
    for (size_t i = 0; i < picture.rgb.size(); ++i) {
        const float* const v = &radiance.values[3 * i];
        const glm::dvec3 pixel(v[0], v[1], v[2]);
        if (isFinite(pixel)) picture.rgb[i] = pixel;
    }
    const compare::LinearErrors errors = compare::linearErrors(expected, picture);
    double mean = 0;
    for (const glm::dvec3& pixel : expected.rgb)
        mean += pixel.x + pixel.y + pixel.z;
    mean /= double(expected.rgb.size());
    const double bias = errors.bias[0] + errors.bias[1] + errors.bias[2];
    const double psnr = compare::psnr(expected, picture);
    return {{"relMse", errors.relMse},
            {"mse", errors.mse},
            {"bias", mean > 0 ? Json(bias / mean) : Json(nullptr)},
            {"psnr", std::isfinite(psnr) ? Json(psnr) : Json(nullptr)},
            {"ssim", compare::ssim(expected, picture)}};
}

} // namespace stromboli::view

#include "scene/images/picture.hpp"

#include <webp/decode.h>

namespace stromboli::images {

Picture decodeWebp(std::string_view bytes, const std::string& name) {
    const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
    WebPBitstreamFeatures features;
    const VP8StatusCode status = WebPGetFeatures(data, bytes.size(), &features);
    if (status != VP8_STATUS_OK)
        failToDecode(name, "WebP",
                     status == VP8_STATUS_NOT_ENOUGH_DATA ? "the file is truncated"
                                                          : "its header is damaged");
    if (features.has_animation) failToDecode(name, "WebP", "it is an animation");
    // The format has at most 2^14 columns and rows; a picture of one colour takes a few bytes.
    requireSize(name, uint64_t(features.width), uint64_t(features.height), 4, bytes.size(), 0);
    Picture picture{uint32_t(features.width), uint32_t(features.height), {}};
    std::vector<uint8_t> values(picture.texelCount() * 4);
    if (!WebPDecodeRGBAInto(data, bytes.size(), values.data(), values.size(),
                            int(picture.width * 4)))
        failToDecode(name, "WebP", "the file is truncated or damaged");
    picture.values = std::move(values);
    return picture;
}

} // namespace stromboli::images

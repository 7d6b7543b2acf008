#include "scene/images/picture.hpp"

#include <webp/decode.h>

#include <algorithm>
#include <memory>

namespace stromboli::images {
namespace {

struct Delete {
    void operator()(WebPIDecoder* decoder) const { WebPIDelete(decoder); }
};

/// Reads the rows that are there; the others become mid grey. Returns how many there are.
int readRows(std::string_view bytes, const Picture& picture, std::vector<uint8_t>& values) {
    std::fill(values.begin(), values.end(), uint8_t(127));
    for (size_t i = 3; i < values.size(); i += 4)
        values[i] = 255;
    const std::unique_ptr<WebPIDecoder, Delete> decoder(
        WebPINewRGB(MODE_RGBA, values.data(), values.size(), int(picture.width * 4)));
    if (!decoder) return 0;
    // Its answer says that there is less than all, which is known.
    WebPIUpdate(decoder.get(), reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    int rows = 0;
    WebPIDecGetRGB(decoder.get(), &rows, nullptr, nullptr, nullptr);
    return rows;
}

} // namespace

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
                            int(picture.width * 4))) {
        constexpr const char* problem = "the file is truncated or damaged";
        if (readRows(bytes, picture, values) == 0) failToDecode(name, "WebP", problem);
        picture.addFault(build::Shortfall::PicturePart, problem);
    }
    picture.values = std::move(values);
    return picture;
}

} // namespace stromboli::images

#pragma once

#include "host/core/text.hpp"
#include "host/denoise/noisy_picture.hpp"
#include "host/film/image.hpp"
#include "host/render/picture_noise.hpp"
#include "host/vulkan/device.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace stromboli {

/// What removes the noise of a picture that is finished.
enum class Denoiser { Off, On, Oidn };
template <>
inline constexpr auto kNamedValues<Denoiser> = std::to_array<NamedValue<Denoiser>>({
    {Denoiser::Off, "off", "the picture as it is"},
    {Denoiser::On, "on", "the program's own"},
    {Denoiser::Oidn, "oidn", "Open Image Denoise, where it is installed"},
});

namespace denoise {

/// What is said of a denoised picture.
struct Summary {
    /// Square root of the relMSE that is predicted of the picture, with its range.
    PictureNoise noise;
    double noisyShare = 0; ///< that the noisy picture has in it, on the mean over the pixels
    double movedLight = 0; ///< the share of all light that limiting single samples has moved
    uint64_t limitedPixels = 0, unknownPixels = 0;
    bool hasLayers = false; ///< albedo, normal and depth were all known
};

struct DenoisedPicture {
    uint32_t width = 0, height = 0;
    std::vector<glm::vec3> mean;  ///< radiance
    std::vector<glm::vec3> error; ///< the root of its expected squared error, as predicted
    Summary summary;
};

/// Throws UsageError if this denoiser cannot be used here: before a long render.
void requireUsable(Denoiser which);

/// Denoises by the program's own filter on a device, or without one by the reference filter, which
/// is slower; or by Open Image Denoise on the CPU. Throws DeviceError, and UsageError with what
/// Open Image Denoise says. `which` is not Off. isUnwanted: asked several times a second on a
/// device; where it says so, the picture has no pixels.
DenoisedPicture denoisePicture(const NoisyPicture& picture, Denoiser which,
                               const vulkan::Device* device,
                               const std::function<bool()>& isUnwanted = {});

/// The channels that a file has beside the denoised picture: the noisy one, and the predicted
/// error.
const std::vector<std::string>& channelNames();
void addChannels(FloatImage& image, const NoisyPicture& noisy, const DenoisedPicture& denoised);

} // namespace denoise
} // namespace stromboli

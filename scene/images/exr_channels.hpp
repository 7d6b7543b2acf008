#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::images {

/// Which channels of an OpenEXR part are what is shown. Empty names are not there.
struct ExrChannels {
    std::string layer;                ///< that they are of, for messages; empty: of none
    std::array<std::string, 3> color; ///< red, green and blue; or Y, RY and BY
    std::string alpha;
    bool isGrey = false;      ///< Y alone
    bool isLuminance = false; ///< luminance and chroma
};

/// The channels without a layer; or else those of the layer that looks most like the picture:
/// Blender calls it ViewLayer.Combined, others rgba or beauty. Nothing where no layer has colours.
std::optional<ExrChannels> exrChannels(const std::vector<std::string>& names);

/// Those of the layer of that name, "" being the channels without one. Nothing where there is no
/// such layer, or it has no colours.
std::optional<ExrChannels> exrChannelsOf(const std::vector<std::string>& names,
                                         const std::string& layer);

/// The names of the layers that have colours, the likeliest picture first.
std::vector<std::string> exrLayers(const std::vector<std::string>& names);

} // namespace stromboli::images

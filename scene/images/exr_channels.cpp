#include "scene/images/exr_channels.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>
#include <utility>

namespace stromboli::images {
namespace {

std::string inSmallLetters(std::string_view text) {
    std::string small(text);
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return small;
}

/// How likely the layer of a name is the picture itself: the lower the likelier. Passes such as
/// normals and depth have no channels of colours, but light passes have.
int rankOf(std::string_view layer) {
    if (layer.empty()) return 0;
    const std::string name = inSmallLetters(layer);
    const std::string_view last = std::string_view(name).substr(name.find_last_of('.') + 1);
    for (const std::string_view picture : {"combined", "rgba", "rgb", "beauty", "color", "colour"})
        if (last == picture) return 1;
    return 2;
}

/// Channels of one layer by what follows its name, in small letters.
using Layer = std::map<std::string, std::string>;

std::string named(const Layer& layer, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (const auto found = layer.find(name); found != layer.end()) return found->second;
    return {};
}

std::optional<ExrChannels> channelsOf(const std::string& name, const Layer& layer) {
    ExrChannels found;
    found.layer = name;
    found.color = {named(layer, {"r", "red"}), named(layer, {"g", "green"}),
                   named(layer, {"b", "blue"})};
    found.alpha = named(layer, {"a", "alpha"});
    const auto isThere = [](const std::string& channel) { return !channel.empty(); };
    if (std::ranges::any_of(found.color, isThere)) return found;
    const std::string luminance = named(layer, {"y"});
    if (luminance.empty()) return std::nullopt;
    // X, Y and Z are a position.
    if (layer.contains("x") && layer.contains("z")) return std::nullopt;
    found.color = {luminance, named(layer, {"ry"}), named(layer, {"by"})};
    found.isLuminance = isThere(found.color[1]) && isThere(found.color[2]);
    found.isGrey = !found.isLuminance;
    return found;
}

/// All of them that have colours: by rank, then in the file's order, which is that of the alphabet.
std::vector<ExrChannels> shownLayers(const std::vector<std::string>& names) {
    std::map<std::pair<int, std::string>, Layer> layers;
    for (const std::string& full : names) {
        const size_t dot = full.find_last_of('.');
        const std::string layer = dot == std::string::npos ? "" : full.substr(0, dot);
        const std::string last = dot == std::string::npos ? full : full.substr(dot + 1);
        layers[{rankOf(layer), layer}].try_emplace(inSmallLetters(last), full);
    }
    std::vector<ExrChannels> shown;
    for (const auto& [key, layer] : layers)
        if (std::optional<ExrChannels> found = channelsOf(key.second, layer))
            shown.push_back(std::move(*found));
    return shown;
}

} // namespace

std::optional<ExrChannels> exrChannels(const std::vector<std::string>& names) {
    std::vector<ExrChannels> shown = shownLayers(names);
    return shown.empty() ? std::nullopt : std::optional(std::move(shown.front()));
}

std::optional<ExrChannels> exrChannelsOf(const std::vector<std::string>& names,
                                         const std::string& layer) {
    for (ExrChannels& channels : shownLayers(names))
        if (channels.layer == layer) return std::move(channels);
    return std::nullopt;
}

std::vector<std::string> exrLayers(const std::vector<std::string>& names) {
    std::vector<std::string> layers;
    for (ExrChannels& channels : shownLayers(names))
        layers.push_back(std::move(channels.layer));
    return layers;
}

} // namespace stromboli::images

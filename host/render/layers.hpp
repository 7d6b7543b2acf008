#pragma once

#include "host/core/text.hpp"
#include "host/film/image_file.hpp"
#include "host/render/seeing.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <string>
#include <vector>

namespace stromboli {

/// What a picture says of each pixel beside its radiance (docs/layers.md).
enum class Layer { Albedo, Normal, Depth, Position, Uv, Object, Material };
template <>
inline constexpr auto kNamedValues<Layer> = std::to_array<NamedValue<Layer>>({
    {Layer::Albedo, "albedo", "color in white light"},
    {Layer::Normal, "normal", "shading normal"},
    {Layer::Depth, "depth", "metres along the camera's axis"},
    {Layer::Position, "position", "in the world, metres"},
    {Layer::Uv, "uv", "first texture coordinates"},
    {Layer::Object, "object", "number of the mesh or sphere"},
    {Layer::Material, "material", "number of the material"},
});

/// Camera rays that a pixel's layers are made of, where the picture has as many samples.
inline constexpr uint32_t kLayerSamples = 16;

/// The channels of a layer: "normal.X", "normal.Y", "normal.Z".
std::vector<std::string> channelsOf(Layer layer);

/// Fills in the channels of these layers, for pixels that follow each other from `first` on.
void addLayers(FloatImage& image, const std::vector<Layer>& layers, size_t first,
               std::span<const SeenPixel> seen, const Scene& scene, const Camera& camera);

/// The names that the numbers of objects and materials stand for, as lists in JSON of which number
/// n means entry n, from 1; nothing for other layers.
PictureNotes legendOf(const std::vector<Layer>& layers, const Scene& scene);

} // namespace stromboli

#pragma once

#include "host/core/text.hpp"
#include "host/film/image_file.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/layer_types.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

// --- What camera rays see ------------------------------------------------------------------------

/// How much of what the camera sees is to be found out.
enum class Seeing {
    Coverage, ///< whether there is a surface
    Surfaces, ///< all of SeenPixel
};

inline constexpr uint32_t kNothingSeen = 0xFFFFFFFFu;

/// What the camera rays of a pixel have found: sums over these rays (docs/guide/layers.md).
struct SeenPixel {
    uint32_t samples = 0; ///< camera rays
    uint32_t hits = 0;    ///< those of them that end on a surface
    double covered = 0;   ///< the sum of the weights that these have by the pixel filter
#define DECLARE_SUM(name, value, otherwise) glm::dvec3 name{0.0};
    SEEN_SUMS(DECLARE_SUM) ///< shaders/shared/layer_types.h
#undef DECLARE_SUM
    /// What the first ray that has hit something has hit, in the scene's order (triangles, then
    /// spheres), and where on it: barycentric weights of the second and third corner.
    uint32_t primitive = kNothingSeen;
    uint32_t placement = kNothingSeen; ///< that it is in, of a prototype's triangle
    double b1 = 0, b2 = 0;

    double coverage() const {
        return samples == 0 ? 0 : covered / samples;
    }
};

/// Traces camera rays without light: a backend, for the picture that it was made for.
class Viewer {
  public:
    virtual ~Viewer() = default;
    /// Traces samples[i] camera rays of each of the pixels that follow each other from `first` on
    /// (Film::pixels), from that of sample `firstSample` on: to the last bit those that
    /// Backend::sample() takes. No more than kMostSeenAtOnce pixels.
    virtual std::vector<SeenPixel> see(uint32_t first, std::span<const uint32_t> samples,
                                       Seeing what, uint32_t firstSample = 0) = 0;

    static constexpr uint32_t kMostSeenAtOnce = 1u << 16; ///< 10 MiB on the device
};

// --- Layers --------------------------------------------------------------------------------------

/// What a picture says of each pixel beside its radiance (docs/guide/layers.md).
#define NAME_LAYER(layer, text, help, channels, value) layer,
enum class Layer { LAYER_LIST(NAME_LAYER) };
#undef NAME_LAYER
#define DESCRIBE_LAYER(layer, text, help, channels, value)                                         \
    NamedValue<Layer>{Layer::layer, text, help},
template <>
inline constexpr auto
    kNamedValues<Layer> = std::to_array<NamedValue<Layer>>({LAYER_LIST(DESCRIBE_LAYER)});
#undef DESCRIBE_LAYER

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

#include "host/render/layers.hpp"

#include "host/core/json.hpp"
#include "scene/model/surface_lookup.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace stromboli {
namespace {

/// What a layer has in a pixel; as many of the numbers as it has channels.
using Values = std::array<double, 3>;

Values meanOf(const glm::dvec3& sum, uint32_t count) {
    const glm::dvec3 v = sum / double(std::max(count, 1u));
    return {v.x, v.y, v.z};
}

Values positionOf(const SeenPixel& s, const Scene& scene) {
    if (s.hits == 0) return {};
    const glm::dvec3 p = s.position / double(s.hits) + scene.origin;
    return {p.x, p.y, p.z};
}

Values depthOf(const SeenPixel& s, const Camera& camera) {
    if (s.hits == 0) return {std::numeric_limits<double>::infinity()};
    // The mean of depths is the depth of the mean.
    return {glm::dot(s.position / double(s.hits) - camera.position, -camera.back)};
}

Values uvOf(const SeenPixel& s, const Scene& scene) {
    if (s.primitive >= scene.triangles.size()) return {};
    const glm::dvec2 uv = attributesAt(scene, s.primitive, s.b1, s.b2).uv[0];
    return {uv.x, uv.y};
}

/// From 1; 0: nothing is seen.
Values objectOf(const SeenPixel& s, const Scene& scene) {
    if (s.primitive == kNothingSeen) return {};
    if (s.placement != kNothingSeen) return {1.0 + scene.placements[s.placement].instance};
    const size_t triangles = scene.triangles.size();
    return {1.0 + (s.primitive < triangles ? scene.triangles[s.primitive].instance
                                           : scene.spheres[s.primitive - triangles].instance)};
}

Values materialOf(const SeenPixel& s, const Scene& scene) {
    if (s.primitive == kNothingSeen) return {};
    const size_t triangles = scene.triangles.size();
    return {1.0 + (s.primitive < triangles ? scene.triangles[s.primitive].material
                                           : scene.spheres[s.primitive - triangles].material)};
}

Values valuesOf(Layer layer, const SeenPixel& s, const Scene& scene, const Camera& camera) {
    switch (layer) {
#define VALUE_OF_LAYER(layer, text, help, channels, value)                                         \
    case Layer::layer:                                                                             \
        return value;
        LAYER_LIST(VALUE_OF_LAYER)
#undef VALUE_OF_LAYER
    }
    return {};
}

std::string_view axesOf(Layer layer) {
    switch (layer) {
#define AXES_OF_LAYER(layer, text, help, channels, value)                                          \
    case Layer::layer:                                                                             \
        return channels;
        LAYER_LIST(AXES_OF_LAYER)
#undef AXES_OF_LAYER
    }
    return "";
}

std::string listOf(const std::vector<std::string>& names) {
    Json list = Json::array();
    for (const std::string& name : names)
        list.push_back(name);
    return list.dump();
}

} // namespace

std::vector<std::string> channelsOf(Layer layer) {
    std::vector<std::string> names;
    for (const char axis : axesOf(layer))
        names.push_back(std::string(nameOf(layer)) + "." + axis);
    return names;
}

void addLayers(FloatImage& image, const std::vector<Layer>& layers, size_t first,
               std::span<const SeenPixel> seen, const Scene& scene, const Camera& camera) {
    for (const Layer layer : layers) {
        const std::vector<std::string> names = channelsOf(layer);
        for (size_t c = 0; c < names.size(); ++c) {
            std::vector<float>& channel = image.channel(names[c]);
            for (size_t i = 0; i < seen.size(); ++i)
                channel[first + i] = float(valuesOf(layer, seen[i], scene, camera)[c]);
        }
    }
}

PictureNotes legendOf(const std::vector<Layer>& layers, const Scene& scene) {
    PictureNotes legend;
    for (const Layer layer : layers) {
        if (layer == Layer::Object) legend.push_back({"Objects", listOf(scene.instances)});
        if (layer != Layer::Material) continue;
        std::vector<std::string> names;
        for (const Material& m : scene.materials)
            names.push_back(m.name);
        legend.push_back({"Materials", listOf(names)});
    }
    return legend;
}

} // namespace stromboli

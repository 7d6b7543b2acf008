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

Values valuesOf(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
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
    case Layer::Albedo:
        return valuesOf(s.albedo / double(std::max(s.samples, 1u)));
    case Layer::Normal:
        return valuesOf(s.normal / double(std::max(s.samples, 1u)));
    case Layer::Depth:
        return depthOf(s, camera);
    case Layer::Position:
        return valuesOf(s.hits > 0 ? s.position / double(s.hits) + scene.origin : glm::dvec3(0));
    case Layer::Uv:
        return uvOf(s, scene);
    case Layer::Object:
        return objectOf(s, scene);
    case Layer::Material:
        return materialOf(s, scene);
    }
    return {};
}

std::string listOf(const std::vector<std::string>& names) {
    Json list = Json::array();
    for (const std::string& name : names)
        list.push_back(name);
    return list.dump();
}

} // namespace

std::vector<std::string> channelsOf(Layer layer) {
    const char* axes = "X";
    if (layer == Layer::Albedo) axes = "RGB";
    if (layer == Layer::Normal || layer == Layer::Position) axes = "XYZ";
    if (layer == Layer::Depth) axes = "Z";
    if (layer == Layer::Uv) axes = "UV";
    std::vector<std::string> names;
    for (const char* axis = axes; *axis; ++axis)
        names.push_back(std::string(nameOf(layer)) + "." + *axis);
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

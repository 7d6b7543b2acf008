#include "host/stress/lookup_picture.hpp"

#include "host/stress/scenes.hpp"

#include <cmath>
#include <limits>

namespace stromboli::stress {

std::vector<glm::dvec3> lookUpInPicture(Run& run, const Scene& textures,
                                        const std::vector<Lookup>& lookups) {
    SceneMaker m;
    m.scene.images = textures.images;
    m.scene.textures = textures.textures;
    for (uint32_t i = 0; i < textures.textures.size(); ++i) {
        Material lamp = emissive(1);
        lamp.textures = {{.slot = TextureSlot::Emission, .texture = i}};
        m.add(lamp);
    }
    // A multiple of 8, as in other cases: pictures of odd sizes are case 65.
    const uint32_t side = (uint32_t(std::ceil(std::sqrt(double(lookups.size())))) + 7) / 8 * 8;
    for (uint32_t i = 0; i < lookups.size(); ++i) {
        m.quad({float(i % side), float(i / side), 0}, {1, 0, 0}, {0, 1, 0}, lookups[i].texture);
        const auto first = uint32_t(m.scene.attributes.size());
        VertexAttributes& corner = m.scene.attributes.emplace_back();
        corner.uv[0] = lookups[i].uv;
        m.scene.attributeCorners.insert(m.scene.attributeCorners.end(), 2, {first, first, first});
    }
    const double middle = 0.5 * side;
    Camera camera = lookingAt({middle, middle, 1}, {middle, middle, 0}, middle);
    camera.orthographic = true;
    const Film film = run.render(m.scene, camera, picture(side, 1, 0)).film;
    std::vector<glm::dvec3> found;
    for (uint32_t i = 0; i < lookups.size(); ++i) { // row 0 of a picture is at the top
        const PixelStatistics& p = film.at(i % side, side - 1 - i / side);
        found.push_back(p.count > 0 ? p.mean
                                    : glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
    }
    return found;
}

} // namespace stromboli::stress

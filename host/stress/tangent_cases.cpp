// Normal maps where texture coordinates, or tangents that are stated, give no frame.
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"
#include "host/stress/totals.hpp"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::stress {
namespace {

/// A square's frame, and whether its normal map is one that can be used.
struct Frame {
    const char* name;
    std::array<glm::vec2, 4> uv; ///< of (0, 0), (1, 0), (1, 1), (0, 1)
    glm::vec4 tangent;
    enum class Map { Leans, LeftOut, Either } map;
};

std::vector<Frame> frames() {
    using Map = Frame::Map;
    const std::array<glm::vec2, 4> upright = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    const std::array<glm::vec2, 4> mirrored = {{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
    const std::array<glm::vec2, 4> point = {
        {{0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}}};
    const std::array<glm::vec2, 4> line = {{{0, 0}, {1, 1}, {2, 2}, {1, 1}}};
    const std::array<glm::vec2, 4> tiny = {{{0, 1e-20f}, {1e-20f, 1e-20f}, {1e-20f, 0}, {0, 0}}};
    const glm::vec4 none(0.0f);
    return {{"upright coordinates", upright, none, Map::Leans},
            {"mirrored coordinates", mirrored, none, Map::Leans},
            {"coordinates of a point", point, none, Map::LeftOut},
            {"coordinates of a line", line, none, Map::LeftOut},
            {"coordinates 1e-20 wide", tiny, none, Map::Either},
            {"a tangent along the normal", upright, {0, 0, 1, 1}, Map::Either},
            {"a tangent against the normal", upright, {0, 0, -1, -1}, Map::Either},
            {"a tangent near the normal", upright,
             glm::vec4(glm::normalize(glm::vec3(1e-3f, 0, 1)), 1), Map::Leans}};
}

/// White squares in light 1 from everywhere, each of one of the frames, with a map that leans by
/// the angle a: of a cosine lobe about it, (1 + cos a) / 2 is above the surface, and the rest meets
/// the geometric normal and is lost. A square whose map is left out keeps all.
Finding degenerateTangents(Run& run) {
    // cos a = 0.8, but for the halves that n/2 + 1/2 is rounded to.
    const glm::vec2 lower(0.8f, 0.5f), upper(0.9f, 1);
    TextureImage image;
    image.width = image.height = 1;
    image.format = TexelFormat::RgbaHalf;
    image.words = {glm::packHalf2x16(lower), glm::packHalf2x16(upper)};
    const glm::dvec2 xy = 2.0 * glm::dvec2(glm::unpackHalf2x16(image.words[0])) - 1.0;
    const double z = 2.0 * double(glm::unpackHalf2x16(image.words[1]).x) - 1;
    const double leaning = (1 + z / std::sqrt(xy.x * xy.x + xy.y * xy.y + z * z)) / 2;

    const std::vector<Frame> all = frames();
    SceneMaker m;
    m.scene.images = {image};
    m.scene.textures = {Texture{}};
    Material white = diffuse(1);
    white.textures = {{.slot = TextureSlot::Normal}};
    const uint32_t material = m.add(white);
    for (size_t i = 0; i < all.size(); ++i) {
        m.quad({float(i), 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
        const auto first = uint32_t(m.scene.attributes.size());
        for (const glm::vec2& uv : all[i].uv)
            m.scene.attributes.push_back({{uv, uv}, glm::vec4(1), all[i].tangent});
        m.scene.attributeCorners.push_back({first, first + 1, first + 2});
        m.scene.attributeCorners.push_back({first, first + 2, first + 3});
    }
    m.add(ambient(1));
    const double middle = 0.5 * double(all.size());
    Camera camera = lookingAt({middle, 0.5, 1}, {middle, 0.5, 0}, middle);
    camera.orthographic = true;
    camera.halfHeight = 0.5;
    RenderSettings s = picture(uint32_t(all.size()), run.amount(256u, 16384u), 1);
    const Film film = run.render(m.scene, camera, s).film;
    Finding f;
    f.bound = 4.5; // a right renderer fails once in 1e5 times
    for (uint32_t x = 0; x < film.width; ++x) {
        bool bad = false;
        for (uint32_t y = 0; y < film.height; ++y) {
            const PixelStatistics& p = film.at(x, y);
            bad = bad || p.rejected > 0 || !(p.mean.x > 0);
        }
        const Totals found(columnOf(film, x));
        const double leans = sigmasOff(found, glm::dvec3(leaning)),
                     plain = sigmasOff(found, glm::dvec3(1));
        double off = all[x].map == Frame::Map::Leans     ? leans
                     : all[x].map == Frame::Map::LeftOut ? plain
                                                         : std::min(leans, plain);
        if (bad) off = std::numeric_limits<double>::infinity();
        if (!(off <= f.measured)) f.measured = off, f.where = all[x].name;
        f.trials += found.all.taken();
    }
    return f;
}

} // namespace

std::vector<Case> tangentCases() {
    return {{"degenerate-tangents", "72", "normal maps without a frame: no black, no gain, no NaN",
             "sigma", "samples", degenerateTangents}};
}

} // namespace stromboli::stress

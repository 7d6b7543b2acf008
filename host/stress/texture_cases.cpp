#include "host/core/random.hpp"
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"
#include "scene/model/surface_lookup.hpp"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::stress {

// --- Textures ------------------------------------------------------------------------------------

// Textures where coordinates and addresses are extreme.

namespace {

uint32_t addTexture(Scene& scene, const Texture& texture) {
    scene.textures.push_back(texture);
    return uint32_t(scene.textures.size() - 1);
}

// --- Borders and coordinates without a place -----------------------------------------------------

/// The range of every texel's colours; what is read beyond a picture is less or more.
constexpr double kLeastTexel = 64 / 255.0, kGreatestTexel = 191 / 255.0;

TextureImage randomImage(uint32_t width, uint32_t height, Random& random) {
    TextureImage image;
    image.width = width, image.height = height;
    for (uint32_t i = 0; i < width * height; ++i) {
        uint32_t word = 0xFF000000u;
        for (uint32_t c = 0; c < 3; ++c)
            word |= (64 + random.below(128)) << 8 * c;
        image.words.push_back(word);
    }
    return image;
}

/// Index of a texel of the picture that goes on for ever as its wrap mode says.
uint32_t indexOf(double i, Wrap wrap, uint32_t n) {
    if (wrap == Wrap::Clamp) return uint32_t(std::clamp(i, 0.0, n - 1.0));
    const double period = wrap == Wrap::Mirror ? 2.0 * n : n;
    const auto within = uint32_t(i - period * std::floor(i / period)); // exact: powers of two
    return within < n ? within : 2 * n - 1 - within;
}

/// Coordinates without a place are 0, and any beyond a clamped picture are its edge. Infinite ones
/// are no number between the corners of a triangle, where they are interpolated by differences.
double placeOf(double u, Wrap wrap) {
    if (wrap == Wrap::Clamp) return std::isfinite(u) ? std::clamp(u, 0.0, 1.0) : 0;
    return std::abs(u) < 0x1p24 ? u : 0;
}

/// The definition (docs/theory/surfaces.md, "Textures"), which shares no step with lookUp() of the
/// scene's model: the picture goes on for ever; tents of one texel's width weigh the texels.
glm::dvec3 defined(const Scene& scene, const Lookup& lookup) {
    const Texture& t = scene.textures[lookup.texture];
    const TextureImage& image = scene.images[t.image];
    // Texture transforms mix both coordinates: what is not finite in one spoils the other.
    const auto place = [](float u, Wrap wrap, float other, uint32_t n) {
        return placeOf(double(u) + 0.0 * double(other), wrap) * n;
    };
    const double x = place(lookup.uv.x, t.wrapU, lookup.uv.y, image.width),
                 y = place(lookup.uv.y, t.wrapV, lookup.uv.x, image.height);
    const auto texel = [&](double i, double j) {
        return glm::dvec3(texelAt(image, t.srgb, indexOf(i, t.wrapU, image.width),
                                  indexOf(j, t.wrapV, image.height)));
    };
    // At a border in a mirrored copy, the texel is that of the same point of the picture itself.
    const auto nearest = [](double i, Wrap wrap, uint32_t n) {
        return std::floor(wrap == Wrap::Mirror ? std::abs(std::remainder(i, 2.0 * n)) : i);
    };
    if (t.nearest)
        return texel(nearest(x, t.wrapU, image.width), nearest(y, t.wrapV, image.height));
    glm::dvec3 sum(0.0);
    for (double j = std::floor(y) - 1; j <= std::floor(y) + 1; ++j)
        for (double i = std::floor(x) - 1; i <= std::floor(x) + 1; ++i)
            sum += std::max(0.0, 1 - std::abs(x - 0.5 - i)) *
                   std::max(0.0, 1 - std::abs(y - 0.5 - j)) * texel(i, j);
    return sum;
}

/// All wrap modes and both filters of 8 x 4 texels and of one. Sizes are powers of two, so that
/// borders of texels are floats, and a nearest texel is one texel, whatever the arithmetic.
Finding uvSeams(Run& run) {
    constexpr uint32_t kWidth = 8, kHeight = 4;
    constexpr float kInfinity = std::numeric_limits<float>::infinity(),
                    kNaN = std::numeric_limits<float>::quiet_NaN();
    Random random(71);
    Scene scene;
    scene.images = {randomImage(kWidth, kHeight, random), randomImage(1, 1, random)};
    for (const uint32_t image : {0u, 1u})
        for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
            for (const bool nearest : {false, true})
                addTexture(scene,
                           {.image = image, .wrapU = wrap, .wrapV = wrap, .nearest = nearest});
    std::vector<float> places = {kNaN,           kInfinity, -kInfinity, 3e38f,        -3e38f,
                                 0x1p24f,        -0x1p24f,  1e6f,       -1e6f,        1e6f + 0.125f,
                                 -1e6f - 0.125f, -0.0f,     1e-30f,     1 - 0x1p-24f, 1 + 0x1p-23f};
    const int beyond = run.amount(1, 4); // copies of the picture
    for (int i = -2 * int(kWidth) * beyond; i <= 4 * int(kWidth) * beyond; ++i)
        places.push_back(float(i) / float(2 * kWidth)); // borders and middles by turns
    std::vector<Lookup> lookups;
    for (uint32_t texture = 0; texture < scene.textures.size(); ++texture)
        for (size_t i = 0; i < places.size(); ++i)
            for (const size_t k : {i, (i + 7) % places.size(), (i * i + 3) % places.size()})
                lookups.push_back({texture, {places[i], places[k]}});
    const std::vector<glm::dvec3> found = lookUpInPicture(run, scene, lookups);
    Finding f;
    f.bound = 0x1p-21; // a texel and three mixtures, each good to 2^-24 of at most 1: eight such
    f.trials = lookups.size();
    for (size_t i = 0; i < lookups.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            double off = std::abs(found[i][c] - defined(scene, lookups[i])[c]);
            if (!(found[i][c] >= kLeastTexel - f.bound && found[i][c] <= kGreatestTexel + f.bound))
                off = kInfinity; // NaN, too
            if (off <= f.measured) continue;
            f.measured = off;
            f.where = fmt::format("texture {} at ({}, {})", lookups[i].texture, lookups[i].uv.x,
                                  lookups[i].uv.y);
        }
    return f;
}

// --- Addresses -----------------------------------------------------------------------------------

/// A texel that says where it is along the longer side and across it, in up to 24 bits.
uint32_t wordAt(uint32_t along, uint32_t across) {
    return 0xFF000000u | (along & 0xFFu) | (across & 0xFFu) << 8 | (along >> 8 & 0x3Fu) << 16 |
           (across >> 8 & 3u) << 22;
}

TextureImage numbered(uint32_t width, uint32_t height) {
    TextureImage image;
    image.width = width, image.height = height;
    image.words.reserve(size_t(width) * height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            image.words.push_back(width > height ? wordAt(x, y) : wordAt(y, x));
    return image;
}

/// The corners and random texels of pictures of 2^20 texels (in a full run 2^24) whose longer side
/// has 16384: behind the first picture, rows of the second begin beyond 2^18. The nearest texel to
/// its middle is that texel, which is a byte to the last bit.
Finding largeTexture(Run& run) {
    constexpr uint32_t kLong = 16384;
    const uint32_t shorter = run.amount(64u, 1024u);
    Scene scene;
    scene.images = {numbered(kLong, shorter), numbered(shorter, kLong)};
    std::vector<Lookup> lookups;
    std::vector<uint32_t> expected;
    Random random(74);
    for (uint32_t image = 0; image < 2; ++image) {
        const uint32_t texture = addTexture(scene, {.image = image, .nearest = true});
        const uint32_t width = scene.images[image].width, height = scene.images[image].height;
        const auto ask = [&](uint32_t x, uint32_t y) {
            lookups.push_back(
                {texture, {(float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height)}});
            expected.push_back(scene.images[image].words[size_t(y) * width + x]);
        };
        for (const uint32_t x : {0u, 1u, width - 2, width - 1})
            for (const uint32_t y : {0u, 1u, height - 2, height - 1})
                ask(x, y);
        for (int i = 0; i < run.amount(500, 50'000); ++i)
            ask(random.below(width), random.below(height));
    }
    const std::vector<glm::dvec3> found = lookUpInPicture(run, scene, lookups);
    Finding f;
    f.trials = lookups.size();
    for (size_t i = 0; i < lookups.size(); ++i) {
        bool right = true;
        for (int c = 0; c < 3; ++c)
            right = right && std::abs(255 * found[i][c] - (expected[i] >> 8 * c & 0xFF)) < 0.5;
        if (right) continue;
        ++f.measured;
        f.where = fmt::format("({}, {})", lookups[i].uv.x, lookups[i].uv.y);
    }
    return f;
}

} // namespace

std::vector<Case> textureCases() {
    return {
        {"uv-seams", "71", "textures at borders, far away, at NaN: what the definition says",
         "difference", "lookups", uvSeams},
        {"large-texture", "74", "texels of pictures 16384 wide or high are those asked for",
         "wrong", "lookups", largeTexture},
    };
}

// --- Tangents ------------------------------------------------------------------------------------

// Normal maps where texture coordinates, or tangents that are stated, give no frame.

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

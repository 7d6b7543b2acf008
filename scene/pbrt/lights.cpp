#include "scene/pbrt/lights.hpp"

#include "scene/build/tolerate.hpp"
#include "scene/build/vectors.hpp"
#include "scene/pbrt/transforms.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stromboli::pbrt {
namespace {

/// The file's lamps shine along z, the builder's along -z.
glm::dmat4 turnedAround(const glm::dmat4& m) {
    return m * glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, -1));
}

Light lamp(const char* name, LightKind kind) {
    Light light;
    light.name = name;
    light.kind = kind;
    light.constantAttenuation = light.linearAttenuation = 0;
    light.quadraticAttenuation = 1;
    return light;
}

/// pbrt-v4 gives a lamp so much power, of which its intensity of 1 has `has`.
double powerFactor(const Parameters& light, double has) {
    const double power = light.number("power").value_or(-1);
    return power > 0 && has > 0 ? power / has : 1;
}

} // namespace

glm::dvec3 Lights::colorOfLight(const Parameters& light, const char* name) {
    glm::dvec3 color = colorOf(context_, light, name, ColorOf::Light).value_or(glm::dvec3(1)) *
                       context_.imagingRatio;
    // pbrt-v3 has a colour there.
    if (const std::optional<glm::dvec3> scale = colorOf(context_, light, "scale", ColorOf::Number))
        color *= *scale;
    return glm::dvec3(context_.builder.lightColor(name, glm::vec3(color)));
}

void Lights::place(const std::string& kind, const Parameters& light,
                   const glm::dmat4& worldFromLight) {
    if (kind == "infinite" || kind == "exinfinite")
        surroundings_.add(light, worldFromLight);
    else if (kind == "point")
        placePoint(light, worldFromLight);
    else if (kind == "distant")
        placeDistant(light, worldFromLight);
    else if (kind == "spot")
        placeSpot(light, worldFromLight);
    else if (kind == "goniometric")
        placeGoniometric(light, worldFromLight);
    else if (kind == "projection")
        placeProjection(light, worldFromLight);
    else
        light.place().fail(fmt::format("'{}' is no light that is read, expected point, distant, "
                                       "spot, infinite, goniometric or projection",
                                       kind));
    light.reportUnread();
}

void Lights::placePoint(const Parameters& p, const glm::dmat4& worldFromLight) {
    Light light = lamp("point", LightKind::Point);
    light.color = glm::vec3(colorOfLight(p, "I") * powerFactor(p, 4 * std::numbers::pi));
    const glm::dmat4 from =
        glm::translate(glm::dmat4(1.0), p.vector("from").value_or(glm::dvec3(0)));
    // pbrt-v3 moves it in the world, after the transformation.
    context_.builder.placeLight(std::move(light),
                                context_.isV3() ? from * worldFromLight : worldFromLight * from);
}

void Lights::placeDistant(const Parameters& p, const glm::dmat4& worldFromLight) {
    Light light = lamp("distant", LightKind::Directional);
    const double illuminance = p.number("illuminance").value_or(-1);
    light.color = glm::vec3(colorOfLight(p, "L") * (illuminance > 0 ? illuminance : 1));
    const glm::dvec3 from = p.vector("from").value_or(glm::dvec3(0)),
                     to = p.vector("to").value_or(glm::dvec3(0, 0, 1));
    const std::optional<glm::dmat4> frame =
        aimed(glm::dvec3(0), glm::dmat3(worldFromLight) * (to - from));
    if (!frame) p.place().fail("has no direction: 'from' and 'to' are one point");
    context_.builder.placeLight(std::move(light), turnedAround(*frame));
}

/// Pictures of the loader's own are no larger than those of files may be.
uint32_t Lights::sideOfPicture(uint32_t usual) const {
    const uint32_t largest = context_.builder.conventions().selection.largestTexture;
    return largest == 0 ? usual : std::min(usual, largest);
}

/// A lamp whose intensity is a picture across its direction, so many tangents to each side.
void Lights::placeProjector(const std::string& name, const Intensity& intensity,
                            const glm::dmat4& worldFromLamp, const glm::dvec2& tangents,
                            const glm::uvec2& texels) {
    TextureImage image{name, texels.x, texels.y, TexelFormat::RgbaHalf, {}};
    std::vector<glm::dvec3> values;
    double most = 0;
    for (uint32_t row = 0; row < texels.y; ++row)
        for (uint32_t column = 0; column < texels.x; ++column) {
            const glm::dvec2 at =
                tangents *
                (2.0 * glm::dvec2((column + 0.5) / texels.x, (row + 0.5) / texels.y) - 1.0);
            // A framed picture grows with the cube of the secant.
            const double cosine = 1 / std::sqrt(1 + glm::dot(at, at));
            values.push_back(intensity(glm::dvec3(at, 1) * cosine) * std::pow(cosine, 3));
            most = std::max({most, values.back().x, values.back().y, values.back().z});
        }
    if (!(most > 0)) return;
    // Half floats are good for fractions.
    for (const glm::dvec3& value : values)
        build::appendTexel(image.words, value / most, build::Layout::Color);
    Texture texture;
    texture.wrapU = texture.wrapV = Wrap::Clamp;
    texture.image = context_.builder.addImage(std::move(image));
    Light light = lamp(name.c_str(), LightKind::Projector);
    light.color = glm::vec3(float(most));
    light.isFramed = true;
    light.falloffAngle = std::numbers::pi_v<float>;
    TextureUse use;
    use.slot = TextureSlot::Projection;
    use.texture = context_.builder.addTexture(texture);
    light.picture = use;
    const auto axis = [&](int i) {
        return build::unit(glm::dvec3(worldFromLamp[i])).value_or(glm::dvec3(0));
    };
    light.edgeX = axis(0) * 0.5 / tangents.x;
    light.edgeY = axis(1) * 0.5 / tangents.y;
    context_.builder.placeLight(std::move(light), turnedAround(worldFromLamp));
}

/// Six of them, which see all directions.
void Lights::placeAllAround(const std::string& name, const Intensity& intensity,
                            const glm::dmat4& worldFromLamp) {
    for (const int axis : {0, 1, 2})
        for (const double side : {1.0, -1.0}) {
            glm::dmat4 face(0.0);
            face[0][(axis + 1) % 3] = side;
            face[1][(axis + 2) % 3] = 1;
            face[2][axis] = side;
            face[3][3] = 1;
            const glm::dmat3 turn(face);
            const uint32_t texels = sideOfPicture(256);
            placeProjector(
                name, [&](const glm::dvec3& d) { return intensity(turn * d); },
                worldFromLamp * face, glm::dvec2(1), glm::uvec2(texels));
        }
}

/// pbrt-v3 falls off by the fourth power of the share of cosines, pbrt-v4 by a smooth step of it.
void Lights::placeSpot(const Parameters& p, const glm::dmat4& worldFromLight) {
    const double cone = p.number("coneangle", 30, 0, 180);
    const double delta = p.number("conedeltaangle", 5, 0, 180);
    const std::optional<glm::dmat4> frame = aimed(p.vector("from").value_or(glm::dvec3(0)),
                                                  p.vector("to").value_or(glm::dvec3(0, 0, 1)));
    if (!frame) p.place().fail("has no direction: 'from' and 'to' are one point");
    const double outer = std::cos(glm::radians(cone));
    const double inner = std::cos(glm::radians(std::max(cone - delta, 0.0)));
    const bool isV3 = context_.isV3();
    const glm::dvec3 color =
        colorOfLight(p, "I") *
        powerFactor(p, 2 * std::numbers::pi * ((1 - inner) + (inner - outer) / 2));
    const Intensity intensity = [=](const glm::dvec3& d) {
        const double wide = inner - outer;
        const double t =
            wide > 0 ? std::clamp((d.z - outer) / wide, 0.0, 1.0) : (d.z >= outer ? 1.0 : 0.0);
        return color * (isV3 ? t * t * t * t : t * t * (3 - 2 * t));
    };
    constexpr double kWidest = 75; // of a single picture across
    const uint32_t side = sideOfPicture(512);
    const glm::dmat4 world = worldFromLight * *frame;
    if (cone > kWidest) return placeAllAround("spot", intensity, world);
    placeProjector("spot", intensity, world,
                   glm::dvec2(std::tan(glm::radians(std::max(cone, 0.1)))), glm::uvec2(side));
}

void Lights::placeGoniometric(const Parameters& p, const glm::dmat4& worldFromLight) {
    const char* name = context_.isV3() || p.has("mapname") ? "mapname" : "filename";
    const std::optional<std::string> file = p.text(name);
    glm::dvec3 color = colorOfLight(p, "I");
    DirectionMap map;
    if (file) map = readDirectionMap(context_, p, *file);
    if (!context_.isV3()) // which takes colours from I alone
        for (glm::vec3& texel : map.image.texels)
            texel = glm::vec3((texel.x + texel.y + texel.z) / 3);
    double mean = 1;
    if (file) {
        mean = 0;
        constexpr int kSide = 64;
        for (int i = 0; i < kSide * kSide; ++i)
            mean += luminance(map.at(
                directionOfSquare({(i % kSide + 0.5) / kSide, (double(i / kSide) + 0.5) / kSide})));
        mean /= kSide * kSide;
    }
    color *= powerFactor(p, 4 * std::numbers::pi * mean);
    // y is up in its picture.
    placeAllAround(
        "goniometric",
        [&](const glm::dvec3& d) {
            return file ? color * map.at({d.x, d.z, d.y}) : color;
        },
        worldFromLight);
}

void Lights::placeProjection(const Parameters& p, const glm::dmat4& worldFromLight) {
    const char* name = context_.isV3() || p.has("mapname") ? "mapname" : "filename";
    const std::string file = p.text(name).value_or("");
    glm::dvec3 color = colorOfLight(p, "I");
    const double fov = p.number("fov", context_.isV3() ? 45 : 90, 0.01, 170);
    const double tangent = std::tan(glm::radians(fov) / 2);
    const images::FloatImage image = images::readFloatImage(context_.files.find(p.place(), file));
    for (const images::PictureFault& fault : image.faults)
        p.replace(fault.kind, fmt::format("{}: {}", file, fault.problem));
    const double aspect = double(image.width) / image.height;
    const glm::dvec2 tangents =
        tangent * glm::dvec2(std::max(aspect, 1.0), std::max(1 / aspect, 1.0));
    const bool isV3 = context_.isV3(); // which has the picture upside down
    const Intensity picture = [&](const glm::dvec3& d) {
        const glm::dvec2 across(d.x, isV3 ? d.y : -d.y);
        const glm::dvec2 at = (across / d.z / tangents + 1.0) / 2.0;
        const auto place = [](double share, uint32_t count) {
            return size_t(std::clamp(share * count, 0.0, double(count - 1)));
        };
        return glm::dvec3(
            image.texels[place(at.y, image.height) * image.width + place(at.x, image.width)]);
    };
    constexpr uint32_t kMostSide = 2048;
    const glm::uvec2 texels = glm::min(glm::uvec2(image.width, image.height), kMostSide);
    double flux = 0;
    for (uint32_t i = 0; i < texels.x * texels.y; ++i) {
        const glm::dvec2 share((i % texels.x + 0.5) / texels.x,
                               (double(i / texels.x) + 0.5) / texels.y);
        const glm::dvec3 d = glm::normalize(glm::dvec3(tangents * (2.0 * share - 1.0), 1));
        flux += luminance(picture(d)) * std::pow(d.z, 3);
    }
    flux *= 4 * tangents.x * tangents.y / (double(texels.x) * texels.y);
    color *= powerFactor(p, flux);
    placeProjector(
        "projection", [&](const glm::dvec3& d) { return color * picture(d); }, worldFromLight,
        tangents, texels);
}

Emission Lights::emission(const std::string& kind, const Parameters& p, double area) {
    if (kind != "diffuse" && kind != "area")
        p.replace(build::Shortfall::Model,
                  fmt::format("'{}' is no light of a shape that is read", kind), "diffuse");
    Emission emission;
    emission.onBothSides = p.flag("twosided", false);
    glm::dvec3 radiance = colorOfLight(p, "L");
    double mean = 1;
    if (const std::optional<std::string> file = p.text("filename")) {
        std::optional<uint32_t> texture;
        build::tolerate(context_.report(), build::Shortfall::Picture,
                        [&] { texture = textures_.picture(p, *file, false, Wrap::Clamp); });
        if (texture) {
            TextureUse use;
            use.slot = TextureSlot::Emission;
            context_.builder.picturesOfEmissionAreLamps();
            use.texture = *texture;
            use.vRow = glm::vec3(0, -1, 1);
            emission.picture = use;
            const TextureImage& image = context_.builder.imageOf(*texture);
            const size_t count = size_t(image.width) * image.height;
            mean = 0;
            for (size_t i = 0; i < count; ++i)
                mean +=
                    luminance(build::colorAt(image, i, context_.builder.textureOf(*texture).srgb));
            mean /= double(std::max<size_t>(count, 1));
        }
    }
    radiance *= powerFactor(p, mean * std::numbers::pi * area * (emission.onBothSides ? 2 : 1));
    emission.radiance = context_.builder.lightColor("L", glm::vec3(radiance));
    p.skip({"samples", "nsamples"});
    p.reportUnread();
    return emission;
}

} // namespace stromboli::pbrt

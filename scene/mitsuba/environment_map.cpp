#include "scene/mitsuba/environment_map.hpp"

#include "scene/build/vectors.hpp"
#include "scene/images/float_image.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

/// The map's axes in the world, unit; the x axis turned round where they are left-handed.
glm::dmat3 axesOf(const Plugin& emitter, bool& isMirrored) {
    const glm::dmat4 m = emitter.transform("to_world");
    glm::dmat3 axes;
    for (const int i : {0, 1, 2}) {
        const std::optional<glm::dvec3> axis = build::unit(glm::dvec3(m[i]));
        if (!axis) emitter.fail("to_world", "has an axis without length");
        axes[i] = *axis;
    }
    constexpr double kChance = 1e-4; // matrices in files carry a few digits
    for (const int i : {0, 1, 2})
        if (std::abs(glm::dot(axes[i], axes[(i + 1) % 3])) > kChance)
            emitter.replaceParameter("to_world", build::Shortfall::Parameter,
                                     "shears the environment, which only turns here");
    isMirrored = glm::determinant(axes) < 0;
    if (isMirrored) axes[0] = -axes[0];
    // Exactly at right angles again, y first: it is what stands upright.
    axes[2] = glm::normalize(glm::cross(axes[0], axes[1]));
    axes[0] = glm::cross(axes[1], axes[2]);
    return axes;
}

/// Mitsuba 0.x may state by which power numbers of a picture are decoded, 1 where they are linear.
/// By now they are light, as sRGB has it.
void decodeAsStated(const Plugin& emitter, const std::filesystem::path& file,
                    images::FloatImage& image) {
    const double gamma = emitter.number("gamma").value_or(0);
    const bool isOfFloats = file.extension() == ".exr" || file.extension() == ".hdr" ||
                            file.extension() == ".rgbe" || file.extension() == ".pfm";
    if (gamma <= 0 || (isOfFloats && gamma == 1)) return;
    if (!image.isEightBit)
        return emitter.replaceParameter("gamma", build::Shortfall::Model,
                                        "is stated for a picture of more than 8 bits a channel");
    for (glm::vec3& texel : image.texels)
        for (const int channel : {0, 1, 2})
            texel[channel] = float(std::pow(linearToSrgb(double(texel[channel])), gamma));
}

} // namespace

bool isEnvironment(const Plugin& emitter) {
    constexpr std::array<std::string_view, 5> kTypes = {"constant", "envmap", "sky", "sun",
                                                        "sunsky"};
    return std::ranges::find(kTypes, emitter.type) != kTypes.end();
}

glm::dmat4 worldFromFileOf(const Plugin& emitter) {
    bool isMirrored = false;
    const glm::dmat3 mapFromFile = glm::transpose(axesOf(emitter, isMirrored));
    if (emitter.type == "envmap" || emitter.isOld) return glm::dmat4(mapFromFile);
    // Skies have their zenith at z.
    const glm::dmat3 upright(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0));
    return glm::dmat4(upright * mapFromFile);
}

void setEnvironmentMap(Context& context, const Plugin& emitter) {
    const std::filesystem::path file = context.document.file(emitter, "filename");
    images::FloatImage image = images::readFloatImage(file);
    for (const images::PictureFault& fault : image.faults)
        emitter.replace(fault.kind, fmt::format("{}: {}", file.string(), fault.problem));
    decodeAsStated(emitter, file, image);
    bool isMirrored = false;
    axesOf(emitter, isMirrored);
    if (isMirrored)
        for (uint32_t row = 0; row < image.height; ++row)
            std::reverse(image.texels.begin() + ptrdiff_t(row) * image.width,
                         image.texels.begin() + ptrdiff_t(row + 1) * image.width);
    Environment environment;
    environment.name = file.string();
    environment.width = image.width;
    environment.height = image.height;
    environment.radiance = std::move(image.texels);
    // Mitsuba 0.x has the first and the last row half a row away from the poles.
    environment.rowsReachPoles = !emitter.isOld && image.height > 1;
    environment.strength = float(emitter.number("scale", 0).value_or(1));
    // Mitsuba's picture begins with -z at its left edge, ours has it in the middle.
    environment.rotation = glm::pi<float>();
    for (const char* unused : {"mis_compensation", "cache"})
        emitter.skip(unused);
    context.builder.setEnvironment(std::move(environment));
}

} // namespace stromboli::mitsuba

#include "host/kernel/environment_table.hpp"

#include "host/core/color.hpp"
#include "host/kernel/alias_table.hpp"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

constexpr uint32_t kMostMantissa = (1u << gpu::ENVIRONMENT_MANTISSA_BITS) - 1;
/// Exponents whose scale, 2^(exponent - bias), is a normal float.
constexpr int kLeastExponent = int(gpu::ENVIRONMENT_EXPONENT_BIAS) - 126, kMostExponent = 255;

float scaleOf(int exponent) {
    return std::ldexp(1.0f, exponent - int(gpu::ENVIRONMENT_EXPONENT_BIAS));
}

} // namespace

void encodeRadiance(const glm::vec3& radiance, gpu::EnvironmentTexel& texel) {
    const float largest = std::max({radiance.x, radiance.y, radiance.z});
    int power = 0; // largest < 2^power
    std::frexp(largest, &power);
    const int exponent = std::clamp(power - int(gpu::ENVIRONMENT_MANTISSA_BITS) +
                                        int(gpu::ENVIRONMENT_EXPONENT_BIAS),
                                    kLeastExponent, kMostExponent);
    uint32_t mantissa[3];
    for (int c = 0; c < 3; ++c)
        mantissa[c] = std::min(uint32_t(radiance[c] / scaleOf(exponent) + 0.5f), kMostMantissa);
    texel.low = mantissa[0] | mantissa[1] << 18;
    texel.high = mantissa[1] >> 14 | mantissa[2] << 4 | uint32_t(exponent) << 22;
}

glm::vec3 decodeRadiance(const gpu::EnvironmentTexel& texel) {
    const uint32_t mantissa[3] = {texel.low, texel.low >> 18 | texel.high << 14, texel.high >> 4};
    glm::vec3 radiance;
    for (int c = 0; c < 3; ++c)
        radiance[c] = float(mantissa[c] & kMostMantissa) * scaleOf(int(texel.high >> 22 & 0xFF));
    return radiance;
}

EnvironmentTable packEnvironment(const Environment& environment) {
    const uint32_t width = environment.width, height = environment.height;
    const size_t count = size_t(width) * height;
    EnvironmentTable table;
    std::vector<double> weights(count);
    std::vector<gpu::EnvironmentTexel> texels(count);
    double sum = 0;
    for (uint32_t y = 0; y < height; ++y) {
        const double sine = std::sin(glm::pi<double>() * (y + 0.5) / height);
        for (uint32_t x = 0; x < width; ++x) {
            const size_t i = size_t(y) * width + x;
            encodeRadiance(environment.radiance[i], texels[i]);
            sum += weights[i] = luminance(decodeRadiance(texels[i])) * sine;
        }
    }
    if (!(sum > 0)) return table;
    {
        const std::vector<AliasColumn> columns = buildAliasTable(weights);
        for (size_t i = 0; i < count; ++i) {
            texels[i].threshold = float(columns[i].threshold);
            texels[i].alias = columns[i].alias;
        }
    }
    weights = {};
    table.texels.reserve(count);
    for (const gpu::EnvironmentTexel& texel : texels)
        appendRows(table.texels, texel);
    // A texel's solid angle is 2 pi / width times pi / height times its sine.
    const double texelsPerAngle = double(count) / (2 * glm::pi<double>() * glm::pi<double>());
    table.light.width = width;
    table.light.height = height;
    table.light.cosRotation = std::cos(environment.rotation);
    table.light.sinRotation = std::sin(environment.rotation);
    table.light.density = float(texelsPerAngle / sum);
    table.luminance = sum / texelsPerAngle * environment.strength;
    return table;
}

} // namespace stromboli

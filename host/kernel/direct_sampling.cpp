#include "host/kernel/direct_sampling.hpp"

#include <stdexcept>

namespace stromboli {
namespace {

/// Lights are sampled one by one or, in turn, each; a single delta light needs no second sample.
void addLightSamples(const LightTable& lights, uint32_t samples, DirectSampling& direct) {
    const uint32_t deltaLights = lights.count - lights.areaCount;
    direct.perLight = samples;
    if (lights.choice == LightChoice::Each)
        direct.lights = lights.areaCount * samples + deltaLights;
    else
        direct.lights = lights.count > 0 ? samples : 0;
    if (lights.count == 1 && deltaLights == 1) direct.lights = direct.perLight = 1;
}

} // namespace

DirectSampling directSampling(const LightTable& lights, const Estimator& settings) {
    DirectSampling direct;
    const uint32_t samples = settings.lightSamples;
    if (settings.countsLightsForHemisphere()) {
        direct.hemisphere = samples * lights.count;
        return direct;
    }
    if (!samplesLights(settings.directLight) && lights.areaCount > 0)
        throw std::invalid_argument("the lights were packed for another way to find direct light");
    const bool samplesAll =
        samplesLights(settings.directLight) && settings.directLight != DirectLight::Mis;
    if (samplesAll && lights.ambientLeftToBounces)
        throw std::invalid_argument("ambient light was left to bounces, which do not look for it");
    if (settings.directLight == DirectLight::Hemisphere) direct.hemisphere = samples;
    addLightSamples(lights, samples, direct);
    return direct;
}

} // namespace stromboli

// Direct light at a surface: samples of lights, and directions of hemisphere sampling (docs/theory/estimator.md, "Direct
// light at a shading point").

/// A direction of hemisphere sampling as a light sample whose light is not known yet.
LightSample hemisphereSample(const Frame frame, PathState path, vec2 u) {
    if (isLitFromBothSides(lobesOf(path.material))) {
        const float side = takesOtherSide(u) ? -1.0 : 1.0;
        const vec3 w = side * toWorld(makeFrame(shadingNormal(path.surface)), sampleUniformHemisphere(u));
        return LightSample(w, true, w, vec3(4.0 * PI / float(frame.hemisphereSamples)), 0.0, NOT_SKY);
    }
    const vec3 w = toWorld(makeFrame(shadingNormal(path.surface)), sampleUniformHemisphere(u));
    return LightSample(w, true, w, vec3(2.0 * PI / float(frame.hemisphereSamples)), 0.0, NOT_SKY);
}

/// A sample of one of the lights, with the probability of its choice and its share of the direct light in
/// its radiance and density.
LightSample lightSample(const Given given, inout PathState path, vec2 u, uint index) {
    SurfacePoint lit = path.surface;
    const bool bothSides = isLitFromBothSides(lobesOf(path.material));
    if (bothSides && takesOtherSide(u)) lit = otherSide(path.surface);
    const PickedLight picked = pickLight(given, litPoint(lit), shadingNormal(lit), index, u);
    LightSample light = sampleLight(given, lit, picked.light, picked.u, path.sampledEmitter);
    if (findsSkyOnArrival()) {
        path.sampledSky = light.sky;
        path.departurePoint = litPoint(lit);
        path.departureNormal = shadingNormal(lit);
        path.departureTable = lit.table;
    }
    if (bothSides) {
        light.radiance *= dot(shadingNormal(lit), light.direction) > 0.0 ? 2.0 : 0.0;
        light.inversePdf *= 2.0;
    }
    const float perProbability =
        picked.probability > 0.0 ? 1.0 / picked.probability : 0.0;
    light.radiance *= perProbability * lightSampleShare(given.frame, index);
    light.inversePdf *= perProbability;
    if (LIGHT_THROUGH_GLASS) {
        path.glass.light = picked.light;
        path.glass.direction = light.direction;
        path.glass.share = vec3(light.inversePdf * lightSampleShare(given.frame, index));
    }
    if (RECORDS) {
        path.recordedLight = picked.light;
        if (light.inversePdf > 0.0) path.recordedPdf = float(LIGHT_SAMPLES) / light.inversePdf;
        else path.recordedPdf = -picked.probability / lightSampleShare(given.frame, index);
    }
    return light;
}

/// Starts the ray of a direct light sample, if it can contribute.
void traceDirectSample(const Given given, inout PathState path, LightSample light, bool hemisphere) {
    const BsdfValue f = evaluateMixture(path.material, path.surface, light.direction);
    path.directValue = f.value * light.radiance;
    if (LIGHT_THROUGH_GLASS) path.glass.share *= f.value;
    if (!(dot(path.directValue, vec3(1.0)) > 0.0)) {
        if (RECORDS) recordLightSample(path, light, 1.0, false);
        return;
    }
    float weight = 1.0;
    if (findsSkyOnArrival()) path.bouncePdf = 0.0;
    if (combines(lobesOf(path.material))) {
        const float pdf = bouncePdfWithGap(given.gap, path.surface, lobesOf(path.material), f.pdf, light.direction);
        const bool isWeightedOnArrival = findsSkyOnArrival() && light.sky != NOT_SKY;
        if (findsSkyOnArrival()) path.bouncePdf = pdf * light.inversePdf;
        if (!isWeightedOnArrival) weight = lightSampleWeight(light.inversePdf, pdf);
        path.directValue *= weight;
        if (LIGHT_THROUGH_GLASS) path.glass.share *= weight;
    }
    if (RECORDS && findsSkyOnArrival() && light.sky != NOT_SKY) {
        const FoundSky sky = skyFrom(given, path.departurePoint, path.departureNormal, path.departureTable, light.direction);
        weight = lightSampleWeight(sky.inversePdf, path.bouncePdf);
        path.recordedPdf /= sky.inversePdf;
    }
    if (RECORDS) recordLightSample(path, light, weight, true);
    const bool transmitted = isBehind(path.surface, light.direction);
    const vec3 origin = leaveThroughMedia(path.surface, light.direction, transmitted);
    const vec3 toEnd = light.infinite ? light.direction : light.target - origin;
    if (OCCLUDERS > 0u && !hemisphere && stopsAtOccluder(given, origin, toEnd, light.infinite)) return;
    if (SHADOW_MAP && !hemisphere && light.infinite && isInShadow(given.shadow, origin, light.direction)) return;
    // What the ray of hemisphere sampling goes through is known when it has arrived.
    if (HAS_ABSORPTION && !hemisphere)
        path.directValue *=
            transmittance(fillingBeyond(path.surface, path.material, path.filling, transmitted).medium,
                          light.infinite ? INFINITE_DISTANCE : length(light.target - origin));
    if (HAS_MEDIA) path.shadowFilling = fillingBeyond(path.surface, path.material, path.filling, transmitted);
    traceFrom(path, path.surface, hemisphere ? PHASE_HEMISPHERE : PHASE_SHADOW, origin, toEnd,
              light.infinite ? INFINITE_DISTANCE : 1.0, transmitted);
}

/// One direct light sample.
void sampleDirect(const Given given, inout PathState path) {
    const uint index = path.directIndex++;
    vec2 u = path.arrivalNumbers.xy;
    if (LIGHT_NUMBERS == LIGHT_NUMBERS_FIRST && index > 0u)
        u = unitFloats(pathWords(given.frame, path, 1u + index)).xy;
    const bool hemisphere = DIRECT_LIGHT == DIRECT_HEMISPHERE && index < given.frame.hemisphereSamples;
    LightSample light;
    if (hemisphere) light = hemisphereSample(given.frame, path, u);
    else light = lightSample(given, path, u, DIRECT_LIGHT == DIRECT_HEMISPHERE ? index - given.frame.hemisphereSamples : index);
    if (RECORDS && hemisphere) {
        path.recordedLight = NO_NAME;
        path.recordedPdf = 1.0 / light.radiance.x;
    }
    traceDirectSample(given, path, light, hemisphere);
}

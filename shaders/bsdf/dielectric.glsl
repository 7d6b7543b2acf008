// Smooth interfaces between dielectrics: glass, and refraction without Fresnel reflection.

/// Unpolarised reflectance of a smooth interface. cosine: of incidence, > 0; eta: index on the
/// incident side over index on the other; cosTransmitted: out, 0 in total reflection.
float fresnelDielectric(float cosine, float eta, out float cosTransmitted) {
    const float sin2 = eta * eta * max(1.0 - cosine * cosine, 0.0);
    cosTransmitted = 0.0;
    if (sin2 >= 1.0) return 1.0;
    cosTransmitted = sqrt(1.0 - sin2);
    const float rs = (eta * cosine - cosTransmitted) / (eta * cosine + cosTransmitted);
    const float rp = (cosine - eta * cosTransmitted) / (cosine + eta * cosTransmitted);
    return 0.5 * (rs * rs + rp * rp);
}

/// Refraction of wo through an interface, or the mirror direction for what is reflected.
BsdfSample crossInterface(Incidence i, float ior, vec3 reflectance, vec3 transmittance,
                          bool reflects, float u) {
    const float eta = i.entering ? 1.0 / ior : ior;
    const float cosine = abs(i.wo.z);
    float cosTransmitted;
    const float exact = fresnelDielectric(cosine, eta, cosTransmitted);
    const bool total = cosTransmitted == 0.0;
    const float fresnel = total || EXACT_FRESNEL ? exact : schlickCs184(cosine, ior);
    if (u < (reflects ? fresnel : 0.0))
        return BsdfSample(vec3(-i.wo.xy, i.wo.z), reflectance, 0.0, LOBE_DELTA_REFLECTION);
    const vec3 refracted =
        vec3(-eta * i.wo.xy, i.wo.z >= 0.0 ? -cosTransmitted : cosTransmitted);
    // Radiance over the squared index is invariant: it is compressed by the square of the ratio.
    const vec3 weight = total ? vec3(0.0) : transmittance * radianceCompression(eta);
    return BsdfSample(refracted, weight, 0.0, LOBE_DELTA_TRANSMISSION);
}

BsdfSample sampleRefraction(RefractionParameters p, Incidence i, vec3 u) {
    return crossInterface(i, p.ior, vec3(0.0), p.transmittance, false, u.z);
}

BsdfSample sampleGlass(GlassParameters p, Incidence i, vec3 u) {
    return crossInterface(i, p.ior, p.reflectance, p.transmittance, true, u.z);
}

// What layers say of a surface (docs/layers.md).

/// Whether what is seen there is another surface: by delta lobes alone, or a principled material without roughness
/// that is all metal or transmits all that it does not reflect.
bool isSeenThrough(Material m) {
    bool isSmooth_ = !scattersIntoManyDirections(lobesOf(m));
    if (isBsdf(m, BSDF_PRINCIPLED)) {
        const PrincipledParameters p = principledParameters(m);
        isSmooth_ = p.roughness == 0.0 && (p.metallic == 1.0 || p.transmission == 1.0);
    }
    return isSmooth_;
}

/// The colour that a mirror or glass gives to what is seen there: the weight of the sample, without what refraction does
/// to radiance by the ratio of the indices.
vec3 tintOf(Material m, BsdfSample b) {
    if (b.lobe != LOBE_DELTA_TRANSMISSION || !(largestComponent(b.weight) > 0.0)) return b.weight;
    vec3 tint = refractionParameters(m).transmittance;
    if (isBsdf(m, BSDF_GLASS)) tint = glassParameters(m).transmittance;
    if (isBsdf(m, BSDF_THIN_DIELECTRIC)) tint = thinDielectricParameters(m).transmittance;
    return tint;
}

/// Reflectance of a conductor at normal incidence.
vec3 normalReflectance(vec3 eta, vec3 k) {
    const vec3 k2 = k * k, less = eta - 1.0, more = eta + 1.0;
    return (less * less + k2) / (more * more + k2);
}

/// The colour of a surface in white light, apart from what its gloss adds.
vec3 albedoOf(Material m) {
    vec3 albedo = uintBitsToFloat(m.row1.xyz); // diffuse, or the base colour
    if (isBsdf(m, BSDF_ROUGH_CONDUCTOR)) {
        const RoughConductorParameters p = roughConductorParameters(m);
        albedo = normalReflectance(p.eta, p.k);
    }
    if (isBsdf(m, BSDF_CONDUCTOR) || isBsdf(m, BSDF_FACET_CONDUCTOR)) {
        const ConductorParameters p = conductorParameters(m);
        albedo = p.reflectance * normalReflectance(p.eta, p.k);
    }
    return albedo;
}

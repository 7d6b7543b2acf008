// What layers say of a surface (docs/guide/layers.md).

/// Whether what is seen there is another surface: by delta lobes alone, or a principled material without roughness
/// that is all metal or transmits all that it does not reflect.
bool isSeenThrough(Material m) {
    bool isSmooth_ = !scattersIntoManyDirections(lobesOf(m));
    if (hasClosure(m, RECIPE_PRINCIPLED)) {
        const PrincipledParameters p = principledParameters(m);
        isSmooth_ = p.roughness == 0.0 && (p.metallic == 1.0 || p.transmission == 1.0);
    }
    return isSmooth_;
}

/// The colour that a mirror or glass gives to what is seen there: the weight of the sample, without what refraction does
/// to radiance by the ratio of the indices.
vec3 tintOf(Material m, BsdfSample b) {
    if (b.lobe != LOBE_DELTA_TRANSMISSION || !(largestComponent(b.weight) > 0.0)) return b.weight;
    if (hasClosure(m, RECIPE_PRINCIPLED)) return principledParameters(m).baseColor;
    return statedParameters(m).color;
}

/// The colour of a surface in white light, apart from what its gloss adds.
vec3 albedoOf(Material m) {
    vec3 albedo = uintBitsToFloat(m.row1.xyz); // of the base, or the base colour
    // The bit says nothing of materials without an interface (SceneClosures).
    if (hasClosure(m, CLOSURE_INTERFACE) && hasClosure(m, INTERFACE_IS_CONDUCTOR)) {
        const StatedParameters p = statedParameters(m);
        albedo = p.color * normalReflectance(p.edge, p.index);
    }
    return albedo;
}

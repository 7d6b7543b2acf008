// What the integrator, light sampling and MIS ask of the closures of a surface: values, densities and samples by
// directions in the world.

/// Whether light samples can find light that the surface scatters.
bool scattersIntoManyDirections(uint lobes) { return (lobes & ~DELTA_LOBES) != 0u; }

/// Whether sampleBsdf() takes all three numbers; else either the first two or the last one.
bool takesThreeNumbers(uint lobes) { return sceneHas(LOBE_GLOSSY_TRANSMISSION) && (lobes & LOBE_GLOSSY_TRANSMISSION) != 0u; }

/// Whether two paths that arrive by the same ray may leave by different ones.
bool scattersAtRandom(uint lobes) {
    return lobes != LOBE_DELTA_REFLECTION && lobes != LOBE_DELTA_TRANSMISSION;
}

Incidence incidenceOn(SurfacePoint s, ShadingFrame frame_) {
    const vec3 wo = toLocal(frame_, s.wo);
    const vec3 coat = sceneHasCoatNormals() ? toLocal(frame_, s.coat) : vec3(0.0, 0.0, 1.0);
    return Incidence(wo, entersWhatItBounds(s.outside, wo), coat);
}

/// Light stays on the side of the true surface that its lobe sends it to.
bool isOnItsSide(SurfacePoint s, vec3 wi, bool transmitted) {
    if (!TESTS_GEOMETRIC_SIDE) return true;
    return transmitted ? dot(s.geometric, wi) < 0.0 : isReflected(s, wi);
}

/// What the bumps of a surface let through of light from wi, or none where wi is over the surface but below the horizon
/// of its mapped normal, or the other way round: as a surface of facets whose roughness alpha^2 is an eighth of the
/// squared tangent of the normal's tilt, 1 at most, would mask it (Conty Estevez, Lecocq and Stein 2019, "A
/// Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem"): 2 / (1 + sqrt(1 + alpha^2 tan^2)), times
/// |cos| above and below, as light may graze.
float reliefShadow(Material m, SurfacePoint s, vec3 wi) {
    const uint rules = reliefRules(m);
    if (rules == 0u) return 1.0;
    const vec3 n = unmappedNormal(s), mapped = shadingNormal(s);
    const float c = dot(n, wi), tilt = dot(n, mapped);
    if (c * dot(mapped, wi) <= 0.0) return 0.0;
    if ((rules & MATERIAL_RELIEF_SHADOWS) == 0u) return 1.0;
    const float c2 = c * c, tilt2 = tilt * tilt;
    const float alpha2 = min(0.125 * max(1.0 - tilt2, 0.0) / max(tilt2, TINY), 1.0);
    return 2.0 * abs(c) / (abs(c) + sqrt(c2 + alpha2 * max(1.0 - c2, 0.0)));
}

BsdfValue evaluateOnSurface(Material m, SurfacePoint s, vec3 wi) {
    const ShadingFrame frame_ = shadingFrame(s);
    const vec3 local = toLocal(frame_, wi);
    const bool transmitted = local.z < 0.0;
    const bool possible =
        (transmitted ? (lobesOf(m) & TRANSMISSION_LOBES & ~DELTA_LOBES) != 0u : local.z > 0.0) &&
        isOnItsSide(s, wi, transmitted);
    if (!possible) return NO_SCATTERING;
    BsdfValue f = evaluateLocally(m, incidenceOn(s, frame_), local);
    if (RELIEF_RULES) f.value *= reliefShadow(m, s, wi);
    return f;
}

/// f |cos| and the density for the unit world direction wi, of all lobes but delta ones; of a medium, the phase function.
/// s: faced forward.
BsdfValue evaluateBsdf(Material m, SurfacePoint s, vec3 wi) {
    BsdfValue f = evaluateOnSurface(m, s, wi);
    if (HAS_PHASES && isPhase(m)) f = evaluatePhase(m, s.wo, wi);
    return f;
}

BsdfSample sampleOnSurface(Material m, SurfacePoint s, vec3 u) {
    const ShadingFrame frame_ = shadingFrame(s);
    BsdfSample b = sampleLocally(m, incidenceOn(s, frame_), u);
    b.direction = toWorld(frame_, b.direction);
    // Mirrored and refracted directions keep the length of wo but for rounding, which would add up
    // along a path.
    if ((b.lobe & DIFFUSE_LOBES) == 0u) b.direction = unit(b.direction);
    if (!isOnItsSide(s, b.direction, isTransmission(b.lobe))) b.weight = vec3(0.0);
    if (RELIEF_RULES) b.weight *= reliefShadow(m, s, b.direction);
    return b;
}

/// Samples the direction in which light goes on. u, each in [0, 1): x and y for the direction within
/// a lobe, z for the choice of one of several lobes. s: faced forward.
BsdfSample sampleBsdf(Material m, SurfacePoint s, vec3 u) {
    BsdfSample b = sampleOnSurface(m, s, u);
    if (HAS_PHASES && isPhase(m)) b = samplePhase(m, s.wo, u.xy);
    return b;
}

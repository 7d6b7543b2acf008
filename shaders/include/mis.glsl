// Multiple importance sampling (Veach and Guibas 1995): light that both a light sample and a bounce may
// find is shared between them by the power heuristic with exponent 2. A narrow lobe finds a large light
// better than points on the light find the lobe, a wide lobe finds a small light worse. MIS_LOBES says for
// which lobes that is done (docs/theory/estimator.md, "MIS"); a scene where it does not help has none, and none of
// this is in its kernel.

/// Whether a bounce from a surface with any of these lobes shares finding lights with its light samples.
bool combines(uint lobes) { return (lobes & MIS_LOBES) != 0u; }

/// 1 / (1 + (q / p)^2).
float powerHeuristic(float qOverP) { return 1.0 / (1.0 + qOverP * qOverP); }

/// The weight of a light sample that could also have come from a bounce of density bouncePdf. inversePdf: of one of
/// LIGHT_SAMPLES samples (steradians), the choice of the light included; 0: no bounce finds that light.
float lightSampleWeight(float inversePdf, float bouncePdf) {
    return powerHeuristic(bouncePdf * inversePdf / float(LIGHT_SAMPLES));
}

/// The weight of light found by a bounce, bouncePdf > 0.
float bounceWeight(float inversePdf, float bouncePdf) {
    return powerHeuristic(float(LIGHT_SAMPLES) / max(bouncePdf * inversePdf, TINY));
}

/// A ray that has found light, were there no glass on its way: as it has left its surface.
struct StraightRay {
    bool isBehindGlass;
    bool isSample;      ///< it is a light sample's, meant for this light (LightEntry::light)
    uint light;
    bool keepsDirection; ///< behind glass it is as far from the sky as before (clear_glass.glsl)
};

/// The weight of the light that ray t, a bounce from a surface with this normal, has found: the emissive surface it
/// has hit, or this sky. What no light sample goes to is left to bounces. bouncePdf: behind glass 0 where all that light
/// samples go to is left to them.
float foundLightWeight(const Given given, Traversal t, vec3 normal, FoundSky sky, float bouncePdf, StraightRay straight) {
    const bool hit = t.hitPrimitive != NO_PRIMITIVE;
    PlacedPrimitive place;
    uint number = given.frame.ambientLight;
    if (hit) {
        place = fetchPlace(t.hitPrimitive);
        number = place.light;
    }
    if (number == NO_LIGHT) return straight.isSample ? 0.0 : 1.0;
    const LightEntry entry = lightEntry(given.roots, number);
    if (LIGHT_THROUGH_GLASS && straight.isBehindGlass) {
        bool leads = straight.keepsDirection;
        if (hit) leads = leadsTo(given, place, entry.light, t.origin, t.direction);
        if (straight.isSample) return leads && (LIGHT_CHOICE == LIGHT_CHOICE_ONE || entry.light == straight.light) ? 1.0 : 0.0;
        if (!leads) return 1.0;
    }
    const float probability = lightProbability(given, entry, t.origin, normal);
    if (!(probability > 0.0)) return 1.0;
    if (LIGHT_THROUGH_GLASS && bouncePdf == 0.0) return 0.0;
    const float inversePdf = hit ? areaLightInversePdf(given, t, place, entry.light) : sky.inversePdf;
    return bounceWeight(inversePdf / probability, bouncePdf);
}

// Which light a light sample goes to. pickLight() takes one, lightProbability() tells how likely it was to;
// nobody else knows how it is done (LIGHT_CHOICE).

struct PickedLight {
    uint light;        ///< as LightEntry::light
    float probability; ///< 0: no light reaches the surface
    vec2 u;            ///< what is left of the random numbers: uniform, independent of the choice
};

/// By the alias table.
uint pickByAlias(const Frame frame, inout ChoiceNumber c) {
    uint column, fraction;
    umulExtended(c.value << 1u, frame.lightCount, column, fraction);
    const AliasColumn a = fetchAliasColumn(frame, column);
    const float within = float(int(fraction >> 8u)) * (1.0 / 16777216.0);
    const bool own = within < a.threshold;
    const float low = own ? 0.0 : a.threshold, width = own ? a.threshold : 1.0 - a.threshold;
    const float u = clamp((within - low) / max(width, TINY), 0.0, 1.0 - UNIT_ROUNDOFF);
    c.value = uint(int(u * 16777216.0)) << 7u | newDigits(c) >> 25u;
    return own ? column : a.alias;
}

/// The light of sample number `index` at a surface with unit normal n, whose point that light leaves from
/// is p. u: two numbers in [0, 1), multiples of 2^-24; the choice uses up digits of the first.
PickedLight pickLight(const Given given, vec3 p, vec3 n, uint index, vec2 u) {
    if (LIGHT_CHOICE == LIGHT_CHOICE_ONE) return PickedLight(onlyLightReference(), 1.0, u);
    if (LIGHT_CHOICE == LIGHT_CHOICE_EACH) {
        // Each light in turn, LIGHT_SAMPLES times; delta lights, which are behind the others, once.
        const uint sampled = given.frame.areaLights * LIGHT_SAMPLES;
        const uint number = index < sampled ? index / LIGHT_SAMPLES : given.frame.areaLights + index - sampled;
        return PickedLight(fetchLightEntry(number).light, 1.0, u);
    }
    ChoiceNumber c = choiceNumber(u);
    float probability;
    uint number;
    if (LIGHT_CHOICE == LIGHT_CHOICE_TREE)
        number = walkLightTree(given, p, n, false, LightEntry(0u, 0u, 0.0, 0u), c, probability);
    else
        number = pickByAlias(given.frame, c);
    const LightEntry entry = lightEntry(given.roots, number);
    if (LIGHT_CHOICE != LIGHT_CHOICE_TREE) probability = entry.probability;
    return PickedLight(entry.light, probability, vec2(restOf(c), u.y));
}

/// The probability with which pickLight() takes this light.
float lightProbability(const Given given, LightEntry entry, vec3 p, vec3 n) {
    if (LIGHT_CHOICE == LIGHT_CHOICE_ONE || LIGHT_CHOICE == LIGHT_CHOICE_EACH) return 1.0;
    if (LIGHT_CHOICE != LIGHT_CHOICE_TREE) return entry.probability;
    ChoiceNumber none = ChoiceNumber(0u, 0u);
    float probability;
    walkLightTree(given, p, n, true, entry, none, probability);
    return probability;
}

/// The share that one of a surface's light samples has in its direct light.
float lightSampleShare(const Frame frame, uint index) {
    const bool sampledOnce =
        LIGHT_CHOICE == LIGHT_CHOICE_EACH && index >= frame.areaLights * LIGHT_SAMPLES;
    return sampledOnce ? 1.0 : 1.0 / float(LIGHT_SAMPLES);
}

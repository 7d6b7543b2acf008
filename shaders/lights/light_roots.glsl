// The roots of the light tree, which are the same for all surfaces: they are read once for all paths. Where they are all
// lights that there are, so are these (docs/theory/kernel.md, "Nothing is moved out of loops").

bool looksAtRoots() { return LIGHT_CHOICE == LIGHT_CHOICE_TREE && hasSeveralGroups(); }

/// The roots are all lights that there are.
bool holdsAllLights() { return looksAtRoots() && !LIGHT_TREES_BRANCH; }

LightRoots findRoots(const Frame frame) {
    LightRoots roots;
    for (uint group = 0u; group < LIGHT_GROUP_COUNT; ++group) {
        LightRoot root;
        root.number = NO_LIGHT;
        if (looksAtRoots() && hasGroup(group) && lightsInGroup(frame, group) > 0u) {
            root.number = atRoot(frame, group).first;
            root.bounds = boundsOf(fetchLightNode(frame, 2u * root.number + 1u, lightsHaveCones()));
            if (holdsAllLights()) {
                root.entry = fetchLightEntry(root.number);
                if (!isTriangleLight(root.entry.light)) root.rows = fetchLightRows(root.entry.light);
            }
        }
        roots.all[group] = root;
    }
    return roots;
}

/// What a light's number stands for.
LightEntry lightEntry(const LightRoots roots, uint number) {
    if (!holdsAllLights()) return fetchLightEntry(number);
    LightEntry entry = LightEntry(0u, 0u, 0.0, 0u);
    for (uint group = 0u; group < LIGHT_GROUP_COUNT; ++group)
        if (hasGroup(group) && roots.all[group].number == number) entry = roots.all[group].entry;
    return entry;
}

/// light: as LightEntry::light; no triangle.
LightRows rowsOfLight(const Given given, uint light) {
    if (LIGHT_CHOICE == LIGHT_CHOICE_ONE) return given.onlyLight.rows;
    if (!holdsAllLights()) return fetchLightRows(light);
    LightRows rows = LightRows(uvec4(0u), uvec4(0u), uvec4(0u), uvec4(0u));
    for (uint group = 0u; group < LIGHT_GROUP_COUNT; ++group)
        if (hasGroup(group) && given.roots.all[group].entry.light == light) rows = given.roots.all[group].rows;
    return rows;
}

// Phase functions: the closures of media. cos: between the directions in which light goes before and after; densities
// by solid angle, whose integral is 1, so that samples in proportion to them have the weight 1. A point in a medium has no
// normal: both of its normals are zero. Under surfaces, where no light samples are taken, a phase function counts as a delta
// lobe, as light comes there by bounces alone.

const bool HAS_PHASES = (CLOSURES & (PHASE_FUNCTION)) != 0u;
const bool MIXES_PHASES = (MEDIA & MEDIA_MIX) != 0u;

/// Whether a normal is that of a point in a medium.
bool isNowhere(vec3 normal) { return MEDIA != 0u && normal == vec3(0.0); }

bool isPhase(Material m) { return hasClosure(m, PHASE_FUNCTION); }
bool isUnderSurface(Material m) {
    return (MEDIA & MEDIA_UNDER_SURFACE) != 0u && hasClosure(m, LOBE_DELTA_REFLECTION);
}
float asymmetryOf(Material m) { return uintBitsToFloat(m.row1.w); }
PhaseMixture phasesOf(Material m) {
    const vec4 r = uintBitsToFloat(m.row4);
    return PhaseMixture(r.x, r.y, r.z, r.w);
}

bool isRayleigh(float asymmetry) { return sceneHas(PHASE_IS_RAYLEIGH) && asymmetry == RAYLEIGH_ASYMMETRY; }

/// Of one function. oneMinusCos: 1 - cos, whose digits the peak of a narrow function needs.
float phaseDensity(float g, float oneMinusCos) {
    const float square = (1.0 - g) * (1.0 - g) + 2.0 * g * oneMinusCos, cosine = 1.0 - oneMinusCos;
    float density = (1.0 - g) * (1.0 + g) * (0.25 * INV_PI) / max(square * sqrt(square), TINY);
    if (isRayleigh(g)) density = (0.1875 * INV_PI) * (1.0 + cosine * cosine);
    return density;
}

float phaseDensity(Material m, float oneMinusCos) {
    float density = phaseDensity(asymmetryOf(m), oneMinusCos);
    if (MIXES_PHASES) {
        const PhaseMixture p = phasesOf(m);
        density = (1.0 - p.share1 - p.share2) * density + p.share1 * phaseDensity(p.asymmetry1, oneMinusCos) +
                  p.share2 * phaseDensity(p.asymmetry2, oneMinusCos);
    }
    return density;
}

/// 1 - cos of a sample of one function. Henyey and Greenstein's, from the inverse of its distribution, which is written so
/// that no difference of large terms is left and g = 0 is no exception; Rayleigh's is the root of a cubic equation.
float samplePhase(float g, float u) {
    const float d = (1.0 - g) + 2.0 * g * u;
    float oneMinusCos = (1.0 - g) * (1.0 - g) * (1.0 + (1.0 + g) / d) * (1.0 - u) / d;
    if (isRayleigh(g)) {
        const float z = 4.0 * u - 2.0, root = pow(abs(z) + sqrt(z * z + 1.0), 1.0 / 3.0);
        const float cosine = root - 1.0 / root;
        oneMinusCos = 1.0 - (z < 0.0 ? -cosine : cosine);
    }
    return clamp(oneMinusCos, 0.0, 2.0);
}

/// wo: back along the ray.
BsdfValue evaluatePhase(Material m, vec3 wo, vec3 wi) {
    const vec3 turn = wi + wo;
    const float density = phaseDensity(m, 0.5 * dot(turn, turn));
    return BsdfValue(vec3(density), density);
}

BsdfSample samplePhase(Material m, vec3 wo, vec2 u) {
    float g = asymmetryOf(m);
    if (MIXES_PHASES) { // of a sum: one by its share, with what is left of the number
        const PhaseMixture p = phasesOf(m);
        const float both = p.share1 + p.share2;
        const bool isFirst = u.x < p.share1, isSecond = !isFirst && u.x < both;
        g = isFirst ? p.asymmetry1 : (isSecond ? p.asymmetry2 : g);
        const float from = isFirst ? 0.0 : (isSecond ? p.share1 : both);
        const float share = isFirst ? p.share1 : (isSecond ? p.share2 : 1.0 - both);
        u.x = min((u.x - from) / share, 1.0);
    }
    const float oneMinusCos = samplePhase(g, u.x);
    const vec3 local = vec3(sqrt(max(oneMinusCos * (2.0 - oneMinusCos), 0.0)) * cosSin(4.0 * u.y), 1.0 - oneMinusCos);
    const float density = phaseDensity(m, oneMinusCos);
    return BsdfSample(toWorld(makeFrame(-wo), local), vec3(1.0), density,
                      isUnderSurface(m) ? LOBE_DELTA_REFLECTION : LOBE_DIFFUSE_REFLECTION);
}

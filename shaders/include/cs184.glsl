// All that the kernel does differently under the conventions of the CS184 renderer (docs/guide/cs184.md says
// why, docs/guide/cs184.md, "CS184 mode", what). Other files ask for a convention by its name; the
// specialisation constant CS184 is read here only, for two sets of conventions. They have the names that
// they have on the host (host/render/estimator.hpp).

/// Normals are turned to the side of wo; with that the lit point may be lifted onto the smooth surface
/// (FLAT_TERMINATOR).
const bool FACES_FORWARD = !CS184;
/// Light stays on the side of the geometric surface that its lobe sends it to.
const bool TESTS_GEOMETRIC_SIDE = !CS184;
/// Fresnel's equations; else that renderer's approximations below.
const bool EXACT_FRESNEL = !CS184;
/// Smith's Lambda; else that renderer's form of it.
const bool EXACT_LAMBDA = !CS184;
/// Refraction multiplies radiance by the squared ratio of the indices; else it divides.
const bool COMPRESSES_RADIANCE = !CS184;
/// Emission found by bounces that miss everything, or from non-delta surfaces, counts where light samples
/// do not; else only emissive geometry right after a delta surface does.
const bool BOUNCES_FIND_ALL_LIGHT = !CS184;
/// Area lights fall off with the square of the distance, as the solid angle does by which they are
/// sampled; else with the distance, and they are sampled by area.
const bool INVERSE_SQUARE_FALLOFF = !CS184;
/// Ambient light comes from directions about the shading normal; else from those with y > 0.
const bool AMBIENT_ABOUT_NORMAL = !CS184;

/// A refracted path enters where wo is on the outer side of the surface. Where normals are not turned,
/// the side of the shading normal tells.
bool entersWhatItBounds(bool outside, vec3 localWo) {
    return FACES_FORWARD ? outside : localWo.z >= 0.0;
}

/// A direction of ambient light: uniform with y > 0, density 1 / (2 pi).
vec3 sampleAmbientCs184(vec2 u) { return sampleUniformHemisphere(u).xzy; }

/// What refraction does to radiance, eta being the index on the side of wo over the other. That renderer
/// divides where it should multiply.
float radianceCompression(float eta) {
    return COMPRESSES_RADIANCE ? eta * eta : 1.0 / (eta * eta);
}

/// The weight of the last term of Smith's Lambda of Beckmann's facets. That renderer has pi where sqrt(pi) is due,
/// and half of the term's weight is missing in its denominator.
const float LAMBDA_TAIL = EXACT_LAMBDA ? 0.282094791773878 : 0.5 * INV_PI; // 1 / (2 sqrt(pi))

/// Falloff of an area light that is sampled by area, besides the cosine: that renderer's density lacks
/// one factor 1 / distance.
float areaFalloff(float inverseDistance) {
    return INVERSE_SQUARE_FALLOFF ? inverseDistance * inverseDistance : inverseDistance;
}

/// Schlick's approximation as that renderer uses it.
float schlickCs184(float cosine, float ior) {
    const float r = (1.0 - ior) / (1.0 + ior), r0 = r * r;
    const float c = 1.0 - cosine, c2 = c * c;
    return r0 + (1.0 - r0) * c2 * c2 * c;
}

/// That renderer's approximation of a conductor's reflectance, valid for k^2 >> 1; c: cosine between the
/// normal and wi.
vec3 fresnelConductorCs184(float c, vec3 eta, vec3 k) {
    const vec3 s = eta * eta + k * k, e = 2.0 * c * eta;
    const vec3 rs = (s - e + c * c) / (s + e + c * c);
    const vec3 rp = (s * c * c - e + 1.0) / (s * c * c + e + 1.0);
    return 0.5 * (rs + rp);
}

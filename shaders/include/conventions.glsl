// What the kernel does differently where rules of shading do not hold (shared/conventions.h).
// Other files ask for a rule by the name of its constant.

#define DECLARE_CONVENTION(bit, member, name, otherwise) const bool name = (DEPARTURES & bit) == 0u;
CONVENTION_LIST(DECLARE_CONVENTION)

/// A refracted path enters where wo is on the outer side of the surface. Where normals are not turned,
/// the side of the shading normal tells.
bool entersWhatItBounds(bool outside, vec3 localWo) {
    return FACES_FORWARD ? outside : localWo.z >= 0.0;
}

/// A direction of ambient light: uniform with y > 0, density 1 / (2 pi).
vec3 sampleAmbientFromAbove(vec2 u) { return sampleUniformHemisphere(u).xzy; }

/// What refraction does to radiance, eta being the index on the side of wo over the other.
float radianceCompression(float eta) {
    return COMPRESSES_RADIANCE ? eta * eta : 1.0 / (eta * eta);
}

/// The weight of the last term of Smith's Lambda of Beckmann's facets. The other form has pi where sqrt(pi) is due,
/// and half of the term's weight is missing in its denominator.
const float LAMBDA_TAIL = EXACT_LAMBDA ? 0.282094791773878 : 0.5 * INV_PI; // 1 / (2 sqrt(pi))

/// Falloff of an area light that is sampled by area, besides the cosine. Where it is not the inverse
/// square, the density lacks one factor 1 / distance.
float areaFalloff(float inverseDistance) {
    return INVERSE_SQUARE_FALLOFF ? inverseDistance * inverseDistance : inverseDistance;
}

/// Schlick's approximation of a dielectric's reflectance.
float schlickFresnel(float cosine, float ior) {
    const float r = (1.0 - ior) / (1.0 + ior), r0 = r * r;
    const float c = 1.0 - cosine, c2 = c * c;
    return r0 + (1.0 - r0) * c2 * c2 * c;
}

/// An approximation of a conductor's reflectance, valid for k^2 >> 1; c: cosine between the
/// normal and wi.
vec3 approximateFresnelConductor(float c, vec3 eta, vec3 k) {
    const vec3 s = eta * eta + k * k, e = 2.0 * c * eta;
    const vec3 rs = (s - e + c * c) / (s + e + c * c);
    const vec3 rp = (s * c * c - e + 1.0) / (s * c * c + e + 1.0);
    return 0.5 * (rs + rp);
}

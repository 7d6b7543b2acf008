// Lights from infinity: ambient light, which is the same from everywhere, and directional light.

/// Density of the directions of an ambient light's samples, by solid angle: cos / pi about the shading
/// normal, as constant light arrives at a surface.
float ambientPdf(vec3 normal, vec3 w) { return max(dot(normal, w), 0.0) * INV_PI; }

/// Radiance of an ambient light from direction w (unit, away from the surface).
vec3 ambientRadianceOf(LightRows rows, vec3 w) {
    return colorOf(rows) + (w.y > 0.0 ? ambientLight(rows).fromAbove : vec3(0.0));
}

LightSample sampleAmbientLight(SurfacePoint s, LightRows rows, vec2 u) {
    LightSample r;
    if (AMBIENT_ABOUT_NORMAL) {
        const vec3 local = sampleCosineHemisphere(u);
        r.direction = toWorld(makeFrame(shadingNormal(s)), local);
        r.inversePdf = PI / max(local.z, TINY);
    } else {
        r.direction = sampleAmbientCs184(u);
        r.inversePdf = 2.0 * PI;
    }
    r.infinite = true;
    r.target = r.direction;
    r.radiance = ambientRadianceOf(rows, r.direction) * r.inversePdf;
    return r;
}

LightSample sampleDirectionalLight(LightRows rows) {
    const vec3 w = directionalLight(rows).toLight;
    return LightSample(w, true, w, colorOf(rows), 0.0);
}

#ifdef RICH_MATERIALS
#include "lights/environment.glsl"
#endif

/// Radiance of the sky, the scene's ambient light or environment, from direction w. It is the first in the light
/// buffer, if the scene has one; a kernel with everything switched on does not know without looking.
vec3 ambientRadiance(vec3 w) {
    if (!HAS_AMBIENT) return vec3(0.0);
    const LightRows rows = fetchLightRows(0u);
    vec3 radiance = vec3(0.0);
#ifdef RICH_MATERIALS
    if (HAS_ENVIRONMENT && kindOf(rows) == LIGHT_ENVIRONMENT) radiance = environmentFrom(rows, w).radiance;
#endif
    return kindOf(rows) == LIGHT_AMBIENT ? ambientRadianceOf(rows, w) : radiance;
}

/// The inverse of the density with which the sky's light samples at a surface with this normal take direction w.
float skyInversePdf(vec3 normal, vec3 w) {
#ifdef RICH_MATERIALS
    const bool isPicture = HAS_ENVIRONMENT && kindOf(fetchLightRows(0u)) == LIGHT_ENVIRONMENT;
    if (isPicture) return 1.0 / max(environmentFrom(fetchLightRows(0u), w).pdf, TINY);
#endif
    return 1.0 / max(ambientPdf(normal, w), TINY);
}

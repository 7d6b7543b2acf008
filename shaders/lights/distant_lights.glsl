// Lights from infinity: ambient light, which is the same from everywhere, and directional light.

/// Density of the directions of an ambient light's samples, by solid angle: cos / pi about the shading
/// normal, as constant light arrives at a surface; in a medium the same from everywhere.
float ambientPdf(vec3 normal, vec3 w) {
    return isNowhere(normal) ? 0.25 * INV_PI : max(dot(normal, w), 0.0) * INV_PI;
}

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
        if (isNowhere(shadingNormal(s))) {
            r.direction = sampleUniformSphere(u);
            r.inversePdf = 4.0 * PI;
        }
    } else {
        r.direction = sampleAmbientFromAbove(u);
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

#include "lights/environment.glsl"

/// What a ray finds that meets nothing: the scene's ambient light or environment. It is the first in the
/// light buffer, if the scene has one; a kernel with everything switched on does not know without looking.
struct FoundSky {
    vec3 radiance;
    float inversePdf; ///< of the density with which light samples at the surface that it left take its direction
};

const FoundSky NO_SKY = FoundSky(vec3(0.0), 1.0);

/// w: the ray's direction; normal and table: of the surface that it left (guideTable()).
FoundSky skyFrom(vec3 normal, uint table, vec3 w) {
    if (!HAS_AMBIENT) return NO_SKY;
    FoundSky found = FoundSky(vec3(0.0), 1.0 / max(ambientPdf(normal, w), TINY));
    const LightRows rows = fetchLightRows(0u);
    if (kindOf(rows) == LIGHT_AMBIENT) found.radiance = ambientRadianceOf(rows, w);
    if (HAS_ENVIRONMENT && kindOf(rows) == LIGHT_ENVIRONMENT) {
        const EnvironmentValue value = environmentFrom(rows, table, w);
        found = FoundSky(value.radiance, 1.0 / max(value.pdf, TINY));
    }
    return found;
}

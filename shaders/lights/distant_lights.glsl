// Lights from infinity that rays find: ambient light, which is the same from everywhere, and the environment.

#include "lights/portals.glsl"
#include "lights/environment.glsl"

/// Density of the directions of an ambient light's samples, by solid angle: cos / pi about the shading
/// normal, as constant light arrives at a surface; in a medium the same from everywhere.
float ambientPdf(vec3 normal, vec3 w) {
    return isNowhere(normal) ? 0.25 * INV_PI : max(dot(normal, w), 0.0) * INV_PI;
}

/// Radiance of an ambient light from direction w (unit, away from the surface).
vec3 ambientRadianceOf(LightRows rows, vec3 w) {
    return colorOf(rows) + (w.y > 0.0 ? ambientLight(rows).fromAbove : vec3(0.0));
}

LightSample sampleAmbientLight(const Given given, SurfacePoint s, LightRows rows, vec2 u) {
    const vec3 p = litPoint(s), n = shadingNormal(s);
    PortalSample aimed = NOT_AIMED;
    if (PORTALS > 0u) aimed = samplePortals(given, p, n, u);
    vec3 w = aimed.direction;
    float inversePdf = 1.0 / max(ambientPdf(n, w), TINY);
    if (!AMBIENT_ABOUT_NORMAL) {
        w = sampleAmbientFromAbove(u);
        inversePdf = 2.0 * PI;
    } else if (!aimed.isAimed) {
        const vec3 local = sampleCosineHemisphere(u);
        w = toWorld(makeFrame(n), local);
        inversePdf = PI / max(local.z, TINY);
        if (isNowhere(n)) {
            w = sampleUniformSphere(u);
            inversePdf = 4.0 * PI;
        }
    }
    LightSample r = skySampleOnArrival(aimed, w);
    if (PORTALS == 0u || !findsSkyOnArrival()) r = skySample(given, p, n, aimed, w, ambientRadianceOf(rows, w), inversePdf);
    return r;
}

/// What a ray finds that meets nothing: the scene's ambient light or environment. It is the first in the
/// light buffer, if the scene has one; a kernel with everything switched on does not know without looking.
struct FoundSky {
    vec3 radiance;
    float inversePdf; ///< of the density with which light samples at the surface that it left take its direction
    uint portal;      ///< that the direction belongs to (PortalDensity)
};

const FoundSky NO_SKY = FoundSky(vec3(0.0), 1.0, NO_PORTAL);

float lightSampleWeight(float inversePdf, float bouncePdf); // mis.glsl

/// By the light of a sample that is looked up on arrival: what light is per radiance.
vec3 arrivedFrom(FoundSky sky, uint sampledSky, float bouncePdf) {
    const bool isOwn = sampledSky == NO_PORTAL || sampledSky == sky.portal;
    return isOwn ? sky.radiance * (sky.inversePdf * lightSampleWeight(sky.inversePdf, bouncePdf)) : vec3(0.0);
}

/// w: the ray's direction; p, normal and table: of the surface that it left (guideTable()).
FoundSky skyFrom(const Given given, vec3 p, vec3 normal, uint table, vec3 w) {
    if (!HAS_AMBIENT) return NO_SKY;
    FoundSky found = FoundSky(vec3(0.0), 1.0 / max(ambientPdf(normal, w), TINY), NO_PORTAL);
    const LightRows rows = given.sky;
    if (kindOf(rows) == LIGHT_AMBIENT) found.radiance = ambientRadianceOf(rows, w);
    if (HAS_ENVIRONMENT && kindOf(rows) == LIGHT_ENVIRONMENT) {
        const EnvironmentValue value = environmentFrom(rows, table, w);
        found = FoundSky(value.radiance, 1.0 / max(value.pdf, TINY), NO_PORTAL);
    }
    if (PORTALS > 0u) {
        const PortalDensity d = portalDensity(given.portals, p, normal, w);
        found.inversePdf = skyInversePdf(given.frame, d, found.inversePdf);
        found.portal = d.portal;
    }
    return found;
}

// Lights that no ray meets: all that C++ and the kernel say of one. light_types.h reads the tables; GLSL reads the file a
// second time, behind what reads lights (lights/lights.glsl), for how they are sampled.
#ifndef STROMBOLI_SHARED_DELTA_LIGHTS_H
#define STROMBOLI_SHARED_DELTA_LIGHTS_H

// F(name, number, rows, label): as in LIGHT_LIST (light_types.h), whose last entries they are.
#define DELTA_LIGHT_LIST(F) \
    F(DIRECTIONAL, 5, 1, "directional") \
    F(POINT, 6, 2, "point") \
    F(SPOT, 7, 3, "spot") \
    F(PROJECTOR, 8, 3, "projector")

// F(kind, name, flags, parameters, bounds): how one follows from `l`, a Light of the scene whose LightKind is `kind`; all
// C++ (host/kernel/light_kinds.cpp).
//   flags       of LightHeader::kind
//   parameters  its structure, below, in parentheses
//   bounds      statements that set `bounds`, by which the light tree picks it: where it is, the cone in which it shines
//               about its direction, its power, and whether it falls off within `sceneRadius`
#define DELTA_LIGHTS(F) \
    F(Directional, DIRECTIONAL, 0, (DirectionalLight{-l.direction, 0}), setInfinite(bounds, l)) \
    F(Point, POINT, 0, (pointLight(l)), setFalloff(bounds, l, sceneRadius)) \
    F(Spot, SPOT, 0, (pointLight(l)), setFalloff(bounds, l, sceneRadius); setCone(bounds, l)) \
    F(Projector, PROJECTOR, projectorFlags(l), (projectorLight(l, picture)), \
      setFalloff(bounds, l, sceneRadius); setCone(bounds, l))

// F(structure, function, fields, met, sample): as in LIGHT_STRUCTURES (light_types.h).
#define DELTA_LIGHT_STRUCTURES(F) \
    F(DirectionalLight, directionalLight, DIRECTIONAL_LIGHT, isLight(kind, LIGHT_DIRECTIONAL), \
      sampleDirectionalLight(rows)) \
    F(ProjectorLight, projectorLight, PROJECTOR_LIGHT, isLight(kind, LIGHT_PROJECTOR), sampleProjector(s, rows)) \
    F(PointLight, pointLight, POINT_LIGHT, isLight(kind, LIGHT_POINT) || isLight(kind, LIGHT_SPOT), \
      samplePointLight(s, rows))

// F(type, name, row, place): the parameters of a light, as in light_types.h.

/// toLight: unit.
#define DIRECTIONAL_LIGHT(F) \
    F(vec3, toLight, 1, xyz) \
    F(uint, unused, 1, w)

/// A point light, or a spot light: a point light that shines into a cone. attenuation: constant, linear and quadratic.
/// Spot: falloffExponent is that of the cosine to the axis, a unit vector that the light travels along; cosCutoff the
/// cosine of half the opening angle; softness 1 / (cosine of half the inner angle - cosCutoff), or 0: no inner cone.
#define POINT_LIGHT(F) \
    F(vec3, position, 1, xyz) \
    F(float, falloffExponent, 1, w) \
    F(vec3, attenuation, 2, xyz) \
    F(float, cosCutoff, 2, w) \
    F(vec3, axis, 3, xyz) \
    F(float, softness, 3, w)

/// A light that throws a picture (scene/model/light.hpp). u is 0.5 + acrossU . d / axis . d. cosCutoff: of the angle to
/// the axis where it ends; softness: 1 / the angle over which it ends, or 0: at once. picture: first row of its
/// TextureUse in the material buffer; 0: none.
#define PROJECTOR_LIGHT(F) \
    F(vec3, position, 1, xyz) \
    F(float, cosCutoff, 1, w) \
    F(vec3, acrossU, 2, xyz) \
    F(float, softness, 2, w) \
    F(vec3, acrossV, 3, xyz) \
    F(uint, picture, 3, w)

#elif defined(SAMPLES_DELTA_LIGHTS) && !defined(STROMBOLI_DELTA_LIGHTS_ARE_SAMPLED)
#define STROMBOLI_DELTA_LIGHTS_ARE_SAMPLED

// --- How they are sampled: GLSL ------------------------------------------------------------------

LightSample sampleDirectionalLight(LightRows rows) {
    const vec3 w = directionalLight(rows).toLight;
    return LightSample(w, true, w, colorOf(rows), 0.0, NOT_SKY);
}

/// The share of the way to a point light, at its end, where nothing shades: 2^-16, 256 roundings.
/// A light placed in the very plane of a surface (lights often are) would else be shaded by chance.
const float POINT_LIGHT_GAP = 1.52587890625e-5;

LightSample samplePointLight(SurfacePoint s, LightRows rows) {
    const PointLight l = pointLight(rows);
    LightSample r = NO_LIGHT_SAMPLE;
    const vec3 d = l.position - litPoint(s);
    const float distance2 = dot(d, d), distance = sqrt(distance2);
    r.inversePdf = 0.0;
    r.direction = d / distance;
    r.infinite = false;
    r.target = l.position - POINT_LIGHT_GAP * d;
    const float attenuation =
        l.attenuation.x + l.attenuation.y * distance + l.attenuation.z * distance2;
    r.radiance = distance2 > 0.0 ? colorOf(rows) / attenuation : vec3(0.0);
    if (isLight(kindOf(rows), LIGHT_SPOT)) {
        const float cosine = -dot(r.direction, l.axis);
        const float edge = clamp((cosine - l.cosCutoff) * l.softness, 0.0, 1.0);
        const float power =
            l.falloffExponent == 0.0 ? 1.0 : pow(max(cosine, 0.0), l.falloffExponent);
        const float falloff = l.softness > 0.0 ? edge * edge : power;
        r.radiance *= cosine >= l.cosCutoff ? falloff : 0.0;
    }
    return r;
}

/// The angle of a cosine >= 0, in radians; acos has few correct digits.
float angleOf(float cosine) { return 2.0 * atan(sqrt(max(1.0 - cosine, 0.0) / (1.0 + cosine))); }

LightSample sampleProjector(SurfacePoint s, LightRows rows) {
    const ProjectorLight l = projectorLight(rows);
    LightSample r = NO_LIGHT_SAMPLE;
    const vec3 d = l.position - litPoint(s);
    const float distance2 = dot(d, d);
    r.inversePdf = 0.0;
    r.direction = d * inversesqrt(max(distance2, TINY));
    r.infinite = false;
    r.target = l.position - POINT_LIGHT_GAP * d;
    const vec3 normal = unit(cross(l.acrossU, l.acrossV)), axis = hasFlag(rows, LIGHT_IS_MIRRORED) ? -normal : normal;
    const float cosine = -dot(r.direction, axis);
    const vec2 uv = 0.5 - vec2(dot(l.acrossU, r.direction), dot(l.acrossV, r.direction)) / max(cosine, TINY);
    bool shines = distance2 > 0.0 && cosine > l.cosCutoff;
    r.radiance = colorOf(rows) / max(distance2, TINY);
    if (l.softness > 0.0)
        r.radiance *= clamp((angleOf(l.cosCutoff) - angleOf(clamp(cosine, 0.0, 1.0))) * l.softness, 0.0, 1.0);
    if (hasFlag(rows, LIGHT_IS_FRAMED)) {
        shines = shines && uv == clamp(uv, 0.0, 1.0);
        r.radiance /= max(cosine * cosine * cosine, TINY);
    }
    if (sceneHasSlot(TEXTURE_PROJECTION)) {
        TextureUse t = fetchTextureUse(l.picture);
        if (l.picture == 0u) t = noTexture();
        const vec3 texel = lookUp(t, uv).rgb;
        r.radiance *= l.picture != 0u ? texel : vec3(1.0);
    }
    r.radiance = shines ? r.radiance : vec3(0.0);
    return r;
}

#endif

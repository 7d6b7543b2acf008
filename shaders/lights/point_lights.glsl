// Point and spot lights, and projectors.

/// The share of the way to a point light, at its end, where nothing shades: 2^-16, 256 roundings.
/// A light placed in the very plane of a surface (lights often are) would else be shaded by chance.
const float POINT_LIGHT_GAP = 1.52587890625e-5;

LightSample samplePointLight(SurfacePoint s, LightRows rows) {
    const PointLight l = pointLight(rows);
    LightSample r;
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
    LightSample r;
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

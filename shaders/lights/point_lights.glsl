// Point and spot lights.

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

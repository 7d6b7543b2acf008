// What a plane interface reflects: Fresnel's equations and their approximations.

float mean(vec3 v) { return dot(v, vec3(1.0 / 3.0)); }

float fifthPower(float x) { return x * x * x * x * x; }

vec3 schlick(vec3 f0, float f90, float weight) { return f0 + (f90 - f0) * weight; }

/// Schlick's term at the cosine between direction and half vector.
float schlickWeight(float cosine) { return fifthPower(clamp(1.0 - cosine, 0.0, 1.0)); }

/// Unpolarised reflectance of a dielectric. cosine: of incidence, > 0; eta: index on the incident side over index
/// on the other; cosTransmitted: out, 0 in total reflection.
float fresnelDielectric(float cosine, float eta, out float cosTransmitted) {
    const float sin2 = eta * eta * max(1.0 - cosine * cosine, 0.0);
    cosTransmitted = sqrt(max(1.0 - sin2, 0.0));
    // (a - b) / (a + b) of both polarisations, by one division.
    const vec2 a = vec2(eta * cosine, cosine), b = vec2(cosTransmitted, eta * cosTransmitted), sum = a + b;
    const vec2 r = (a - b) * sum.yx * (1.0 / (sum.x * sum.y));
    return sin2 >= 1.0 ? 1.0 : 0.5 * dot(r, r);
}

/// Unpolarised reflectance of a conductor of index eta + i k (Lagarde 2013, "Memo on Fresnel equations").
vec3 fresnelConductor(float cosine, vec3 eta, vec3 k) {
    const float cos2 = cosine * cosine, sin2 = 1.0 - cos2;
    const vec3 eta2 = eta * eta, k2 = k * k;
    const vec3 t0 = eta2 - k2 - sin2;
    const vec3 a2b2 = sqrt(t0 * t0 + 4.0 * eta2 * k2);
    const vec3 a = sqrt(max(0.5 * (a2b2 + t0), vec3(0.0)));
    const vec3 t1 = a2b2 + cos2, t2 = 2.0 * cosine * a;
    const vec3 t3 = cos2 * a2b2 + sin2 * sin2, t4 = t2 * sin2;
    // The mean of rs = (t1 - t2) / (t1 + t2) and rp = rs (t3 - t4) / (t3 + t4).
    return (t1 - t2) * t3 / ((t1 + t2) * (t3 + t4));
}

/// Reflectance of a conductor at normal incidence.
vec3 normalReflectance(vec3 eta, vec3 k) {
    const vec3 k2 = k * k, less = eta - 1.0, more = eta + 1.0;
    return (less * less + k2) / (more * more + k2);
}

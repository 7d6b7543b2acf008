// Lambert's reflection: f = albedo / pi.

BsdfValue evaluateDiffuse(DiffuseParameters p, Incidence i, vec3 wi) {
    const float pdf = wi.z * INV_PI;
    return BsdfValue(p.albedo * pdf, pdf);
}

BsdfSample sampleDiffuse(DiffuseParameters p, Incidence i, vec3 u) {
    const vec3 wi = sampleCosineHemisphere(u.xy);
    return BsdfSample(wi, p.albedo, wi.z * INV_PI, LOBE_DIFFUSE_REFLECTION);
}

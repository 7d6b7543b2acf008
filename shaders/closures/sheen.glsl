// Sheen: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (2017): a distribution of fibres that
// stand up, and a fit of its Lambda, which the authors and KHR_materials_sheen give.

float sheenFit(float x, float alpha) {
    const float t = (1.0 - alpha) * (1.0 - alpha);
    const float a = mix(21.5473, 25.3245, t), b = mix(3.82987, 3.32435, t);
    const float c = mix(0.19823, 0.16801, t), d = mix(-1.97760, -1.27393, t);
    const float e = mix(-4.32054, -4.85967, t);
    return a / (1.0 + b * pow(x, c)) + d * x + e;
}

float sheenLambda(float cosine, float alpha) {
    const float fit = sheenFit(min(cosine, 1.0 - cosine), alpha);
    return exp(cosine < 0.5 ? fit : 2.0 * sheenFit(0.5, alpha) - fit);
}

/// f of sheen of colour 1. Cosines below the least are taken for it: the fit of Lambda falls short there.
float sheenValue(float alpha, vec3 wo, vec3 wi) {
    const vec3 h = unit(wo + wi);
    const float sine = min(length(h.xy), 1.0), inverse = 1.0 / alpha;
    const float d = (2.0 + inverse) * pow(sine, inverse) * (0.5 * INV_PI);
    const float cosO = clamp(wo.z, LEAST_SHEEN_COSINE, 1.0), cosI = clamp(wi.z, LEAST_SHEEN_COSINE, 1.0);
    const float lambdas = sheenLambda(cosO, alpha) + sheenLambda(cosI, alpha);
    return d / ((1.0 + lambdas) * 4.0 * cosO * cosI);
}

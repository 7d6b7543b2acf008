// Interference in a thin film on a surface: Belcour and Barla, "A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence" (2017), with the approximations by which KHR_materials_iridescence takes it to three
// channels: Schlick's term at both interfaces, phases of 0 or pi, two orders of interference.

/// Parts of the spectrum as the eye's three curves weigh them, transformed: that of a wave whose optical path is so many
/// metres times 2 pi longer. shift: of phase, by curve. Each curve is a Gaussian, the first has a second one.
vec3 filmSensitivity(float phase, vec3 shift) {
    const vec3 height = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13), place = vec3(1.6810e6, 1.7953e6, 2.2084e6);
    const vec3 variance = vec3(4.3278e9, 9.3046e9, 6.6121e9);
    const float phase2 = phase * phase;
    vec3 xyz = height * sqrt(2.0 * PI * variance) * cos(place * phase + shift) * exp(-variance * phase2);
    xyz.x += 9.7470e-14 * sqrt(2.0 * PI * 4.5282e9) * cos(2.2399e6 * phase + shift.x) * exp(-4.5282e9 * phase2);
    xyz /= 1.0685e-7;
    return vec3(dot(vec3(3.2404542, -1.5371385, -0.4985314), xyz), dot(vec3(-0.9692660, 1.8760108, 0.0415560), xyz),
                dot(vec3(0.0556434, -0.2040259, 1.0572252), xyz));
}

/// Reflectance of a film in air on a surface that reflects f0 at normal incidence. cosine: in air, > 0; thickness: in
/// nanometres. 1e-4, 0.9999 and 1e-5 are the extension's own: they confine reflectances, which have no scale, to where
/// the index of the surface and the sum over reflections inside the film are finite.
vec3 filmReflectance(float cosine, vec3 f0, float index, float thickness) {
    const float inside2 = 1.0 - max(1.0 - cosine * cosine, 0.0) / (index * index);
    const float cosInside = sqrt(max(inside2, 0.0));
    const float top = (index - 1.0) / (index + 1.0);
    const float r12 = mix(top * top, 1.0, schlickWeight(cosine)), through = 1.0 - r12;
    const vec3 root = sqrt(min(f0 + 1e-4, vec3(0.9999)));
    const vec3 base = (1.0 + root) / (1.0 - root), bottom = (base - index) / (base + index);
    const vec3 r23 = schlick(bottom * bottom, 1.0, schlickWeight(cosInside));
    const vec3 both = clamp(r12 * r23, 1e-5, 0.9999), amplitude = sqrt(both);
    const vec3 inner = through * through * r23 / (1.0 - both);
    const vec3 shift = vec3(index < 1.0 ? 0.0 : PI) + PI * vec3(lessThan(base, vec3(index)));
    const float phase = 2.0 * PI * 2.0e-9 * index * thickness * cosInside;
    const vec3 first = (inner - through) * amplitude;
    const vec3 sum = r12 + inner + 2.0 * first * (filmSensitivity(phase, shift) +
                                                  amplitude * filmSensitivity(2.0 * phase, 2.0 * shift));
    return inside2 <= 0.0 ? vec3(1.0) : clamp(sum, vec3(0.0), vec3(1.0));
}

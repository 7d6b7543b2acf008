// Perfect reflection.

BsdfSample sampleMirror(MirrorParameters p, Incidence i, vec3 u) {
    return BsdfSample(vec3(-i.wo.xy, i.wo.z), p.reflectance, 0.0, LOBE_DELTA_REFLECTION);
}

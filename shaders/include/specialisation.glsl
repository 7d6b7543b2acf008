// Only what a scene needs: the constants of shaders/shared/features.h, and what follows from them.
layout(local_size_x_id = SPEC_WORKGROUP_SIZE) in;
#define DECLARE_CONSTANT(number, type, name, standard, value, all, label, shown, adds) layout(constant_id = number) const type name = standard;
KERNEL_FEATURES(DECLARE_CONSTANT)

/// Whether triangles have normals of their corners. Without these and without maps there is no shading normal
/// beside the geometric one (HAS_NORMALS).
const bool HAS_CORNER_NORMALS = HAS_NORMALS && CORNER_NORMALS;
/// Whether samples are of what the camera sees, without light (seeing.glsl), and of more than whether it sees something.
const bool SEES_SURFACES = INTEGRATOR == INTEGRATOR_LAYERS;
const bool SEES = SEES_SURFACES || INTEGRATOR == INTEGRATOR_COVERAGE;
/// Whether samples have weights by their place about the pixel, some of them negative.
bool samplesHaveWeights() { return PIXEL_FILTER == FILTER_TABLE; }
/// Whether paths end at random by their throughput.
bool endsByThroughput() { return ROULETTE == ROULETTE_THROUGHPUT; }
/// Whether some material of the scene has one of these bits (shared/parameters.h), or each that they concern.
bool sceneHas(uint bits) { return (CLOSURES & bits) != 0u; }
bool sceneHasOnly(uint bit) { return (CLOSURES_OF_ALL & bit) != 0u; }
/// Whether a material has this bit, known without looking where all have it, or none.
bool has(uint closures, uint bit) { return sceneHas(bit) && (sceneHasOnly(bit) || (closures & bit) != 0u); }
/// Whether light samples go to lights of this kind.
bool samplesLightKind(uint kind) { return (LIGHT_KINDS & (1u << kind)) != 0u; }
/// Whether what a light sample to the sky brings is looked up when its ray has found the sky, as for path rays.
bool findsSkyOnArrival() {
    return HAS_AMBIENT && DIRECT_LIGHT == DIRECT_LIGHTS &&
           (samplesLightKind(LIGHT_ENVIRONMENT) || samplesLightKind(LIGHT_AMBIENT) && PORTALS > 0u);
}
/// kind == wanted, known without looking where there is but one, or none of that kind.
bool isLight(uint kind, uint wanted) {
    return samplesLightKind(wanted) && (LIGHT_KINDS == 1u << wanted || kind == wanted);
}

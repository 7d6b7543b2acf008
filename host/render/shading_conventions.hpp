#pragma once

namespace stromboli {

/// Rules of shading by which renderers differ (docs/estimator.md, "CS184 mode", has the formulas).
/// The default is what physics says. Code asks for a convention by its name and does not know whose
/// it is. The names are those of shaders/include/cs184.glsl, which has those of surfaces and light;
/// the kernel knows two sets only, the default and cs184Shading(), but for the terminator offset
/// (host/kernel/kernel_features.hpp).
struct ShadingConventions {
    // Surfaces.

    /// Normals are turned to the side of wo. Otherwise they stay as they are stored, the flat
    /// surface reflects, and the side of the shading normal tells whether a path enters what the
    /// surface bounds.
    bool facesForward = true;
    /// With facesForward: light is reflected from the smooth surface that the normals describe
    /// (docs/numerics.md, "Shading normals and the terminator"); otherwise from the flat triangle.
    bool offsetsTerminator = true;
    /// Light stays on the side of the geometric surface that its lobe sends it to.
    bool testsGeometricSide = true;
    /// Fresnel's equations; otherwise Schlick's approximation for glass, and one for conductors.
    bool exactFresnel = true;
    /// Smith's Lambda of the Beckmann distribution; otherwise with pi in the place of its root.
    bool exactLambda = true;
    /// Refraction multiplies radiance by the squared ratio of the indices; otherwise it divides.
    bool compressesRadiance = true;

    // Light.

    /// Light that bounces find counts wherever light samples do not account for it; otherwise only
    /// that of emissive geometry right after a delta surface, and that which `-H` finds.
    bool bouncesFindAllLight = true;
    /// Area lights fall off with the square of the distance, as the solid angle does by which they
    /// are sampled; otherwise with the distance, and they are sampled by area.
    bool inverseSquareFalloff = true;
    /// Ambient light comes from directions about the shading normal; otherwise from those with
    /// y > 0.
    bool ambientAboutNormal = true;

    // Which lights are sampled.

    /// Light samples go to emissive geometry, which stands for area lights too (scene/model
    /// area_lights.hpp). Otherwise to the lights of the file alone, of which area lights are
    /// rectangles that no ray meets.
    bool samplesEmitters = true;
    /// Each light of the file is a light by itself, even if it is dark, and is sampled at every
    /// shading point. Otherwise LightChoice says which is, of those that shine.
    bool everyLightInTurn = false;
    /// Hemisphere sampling takes Estimator::lightSamples directions for each light of the file,
    /// and delta lights bring nothing. Otherwise delta lights are sampled besides.
    bool hemispherePerLight = false;

    bool operator==(const ShadingConventions&) const = default;
};

/// Those of the CS184 renderer (docs/cs184.md).
constexpr ShadingConventions cs184Shading() {
    return {.facesForward = false,
            .offsetsTerminator = false,
            .testsGeometricSide = false,
            .exactFresnel = false,
            .exactLambda = false,
            .compressesRadiance = false,
            .bouncesFindAllLight = false,
            .inverseSquareFalloff = false,
            .ambientAboutNormal = false,
            .samplesEmitters = false,
            .everyLightInTurn = true,
            .hemispherePerLight = true};
}

} // namespace stromboli

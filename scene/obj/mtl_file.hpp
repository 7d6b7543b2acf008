#pragma once

#include "scene/build/file_place.hpp"
#include "scene/build/report.hpp"
#include "scene/obj/statements.hpp"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::obj {

/// Which number of a picture's texels counts where one is wanted (-imfchan).
enum class MapChannel { Unstated, Red, Green, Blue, Alpha, Luminance };

/// A picture that a material names, with its options.
struct Map {
    build::FilePlace place;
    std::string name;         ///< of the file, as written
    std::string_view content; ///< of a picture that is no file of its own; else empty
    /// Texture coordinates times scale plus offset, v upwards.
    glm::dvec2 scale{1, 1}, offset{0, 0};
    bool clamp = false;
    double strength = 1; ///< -bm
    MapChannel channel = MapChannel::Unstated;
};

/// A material as an MTL file states it; what it does not state is empty.
struct MtlMaterial {
    build::FilePlace place; ///< of newmtl
    std::string name;
    std::optional<glm::dvec3> diffuse, specular, emission, filter;       ///< Kd, Ks, Ke, Tf
    std::optional<double> exponent, ior, dissolve, transparency;         ///< Ns, Ni, d, Tr
    std::optional<double> roughness, metallic, sheen;                    ///< Pr, Pm, Ps
    std::optional<double> clearcoat, clearcoatRoughness;                 ///< Pc, Pcr
    std::optional<double> anisotropy, anisotropyRotation;                ///< aniso, anisor
    std::optional<double> illumination;                                  ///< illum
    std::optional<Map> diffuseMap, specularMap, emissionMap, opacityMap; ///< map_Kd, Ks, Ke, d
    std::optional<Map> roughnessMap, metallicMap, normalMap;             ///< map_Pr, map_Pm, norm
    std::optional<Map> bumpMap;                                          ///< map_bump
    /// Read in files of Blender alone: Ka, map_Ns and map_refl.
    std::optional<glm::dvec3> ambient;
    std::optional<Map> exponentMap, reflectionMap;
    /// Factors of what a dielectric of its index reflects, in place of Ks.
    std::optional<glm::dvec3> specularLevel;
    double transmission = 0; ///< the share of light that goes in, which the colour tints
};

/// Reads the materials of an MTL file, in the file's order. Throws SceneError with its name and
/// line for anything it cannot make sense of.
std::vector<MtlMaterial> readMtlFile(const std::filesystem::path& file, build::Report& report);

} // namespace stromboli::obj

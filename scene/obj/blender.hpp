#pragma once

#include "scene/obj/mtl_file.hpp"

#include <optional>
#include <string_view>

namespace stromboli::obj {

/// The program that wrote an MTL file. Its materials are no Blinn-Phong ones: it writes what its
/// Principled BSDF has in words that mean something else.
struct Blender {
    static constexpr double kWholeCoat = 4; ///< Pc of a coat that covers all

    double largestExponent = 0; ///< what Ns is of a smooth surface
    bool hasLevels = false;     ///< Ks multiplies what Ni reflects, and not what 1.5 does
};

/// What the first line of a file says of it; nothing if it is another program's.
std::optional<Blender> blenderOf(std::string_view text);

/// States what is meant in the words of the metallic-roughness model.
void takeMeaningOf(const Blender& blender, MtlMaterial& material);

} // namespace stromboli::obj

#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/obj/mtl_file.hpp"
#include "scene/obj/pictures.hpp"

namespace stromboli::obj {

/// What a material of an MTL file means here. MTL describes how OpenGL-like renderers shade, and
/// its newer keys a metallic-roughness model; docs/guide/obj_ply.md has the rules by which both
/// become diffuse or principled surfaces.
Material materialOf(const MtlMaterial& stated, build::SceneBuilder& builder, Pictures& pictures);

/// glTF's roughness of a Blinn-Phong highlight of this exponent: alpha^2 = 2 / (Ns + 2) (B. Walter
/// et al., "Microfacet Models for Refraction through Rough Surfaces", 2007, section 5.2, solved for
/// alpha), and the roughness is the square root of alpha.
double roughnessOfExponent(double exponent);

} // namespace stromboli::obj

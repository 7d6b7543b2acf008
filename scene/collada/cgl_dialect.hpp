#pragma once

#include "scene/collada/context.hpp"

#include <optional>

namespace stromboli::collada {

/// The CS184 dialect (docs/guide/cs184.md): elements inside `<extra><technique profile="CGL">`, or
/// CMU462, which names the same ones.

/// The last material element of the effect's dialect; nothing where there is none.
std::optional<Material> readCglMaterial(Context& context, const Element& effect);

/// The radius of a `<sphere>` geometry, in file units; nothing where there is none.
std::optional<double> readCglSphere(Context& context, const Element& geometry);

/// The element that says what a <light> is (<area>, <point>, ...); null where the dialect says
/// nothing that is supported.
const Element* findCglLight(Context& context, const Element& light);

} // namespace stromboli::collada
